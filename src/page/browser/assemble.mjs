// Assembles WebAssembly text to bytes for browsers.
import { readFile } from "node:fs/promises";
import { basename } from "node:path";
import wabt from "wabt";

export async function assembled(path) {
  const { parseWat } = await wabt();
  return parseWat(basename(path), await readFile(path, "utf8"), { simd: true }).toBinary({}).buffer;
}
