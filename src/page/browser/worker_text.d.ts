// build.mjs makes a text of the worker's program.
declare module "worker:*" {
  const program: string;
  export default program;
}
