// Imports that build.mjs resolves: the text of a worker's program.
declare module "worker:*" {
  const program: string;
  export default program;
}

// The bytes of a kernel.
declare module "wat:*" {
  const program: Uint8Array<ArrayBuffer>;
  export default program;
}
