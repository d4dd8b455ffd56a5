// Decodes the text in the page to the container's bytes: base64, then gzip, with progress.

/** Characters decoded at a time: a multiple of 4, small enough that the loading bar moves. */
const SLICE = 1 << 20;

function decodeSlice(text: string): Uint8Array<ArrayBuffer> {
  const binary = atob(text);
  const bytes = new Uint8Array(binary.length);
  for (let k = 0; k < binary.length; ++k) bytes[k] = binary.charCodeAt(k);
  return bytes;
}

/**
 * `progress` is called with the share of the text that is decoded, 0 to 1. Throws an Error with one clear line
 * if the data are damaged; gzip has a checksum of them.
 */
export async function unpack(base64: string, progress: (share: number) => void): Promise<ArrayBuffer> {
  const text = base64.trim();
  let next = 0;
  const compressed = new ReadableStream<Uint8Array<ArrayBuffer>>({
    async pull(controller) {
      if (next >= text.length) return controller.close();
      controller.enqueue(decodeSlice(text.slice(next, next + SLICE)));
      next += SLICE;
      progress(Math.min(1, next / text.length));
      await new Promise((resume) => setTimeout(resume)); // lets the browser draw the bar
    },
  });
  try {
    return await new Response(compressed.pipeThrough(new DecompressionStream("gzip"))).arrayBuffer();
  } catch {
    throw new Error("The page's data are damaged; write the page again with radiosity view");
  }
}
