// The renderer, and the end of its work.

/** The renderer's name. Some browsers give it only by an extension, of which others warn. */
function rendererOf(gl: WebGL2RenderingContext): string {
  const name = String(gl.getParameter(gl.RENDERER));
  const unmasked = name === "WebKit WebGL" ? gl.getExtension("WEBGL_debug_renderer_info") : null;
  return unmasked ? String(gl.getParameter(unmasked.UNMASKED_RENDERER_WEBGL)) : name;
}

/** Whether the CPU draws, which is slower than a GPU. */
export function drawsInSoftware(gl: WebGL2RenderingContext): boolean {
  return /swiftshader|llvmpipe|software|basic render/i.test(rendererOf(gl));
}

/** Resolves when everything is drawn; false: the context was lost. */
export async function drawn(gl: WebGL2RenderingContext): Promise<boolean> {
  const sync = gl.fenceSync(gl.SYNC_GPU_COMMANDS_COMPLETE, 0);
  if (!sync) return false;
  gl.flush();
  for (;;) {
    if (gl.isContextLost()) return false;
    const status = gl.clientWaitSync(sync, 0, 0);
    if (status === gl.ALREADY_SIGNALED || status === gl.CONDITION_SATISFIED) break;
    await new Promise((resume) => setTimeout(resume, 1));
  }
  gl.deleteSync(sync);
  return true;
}
