// Says what failed in place of the page, of which any part but the first lines may be missing.

/** Whether the document, which has been read, lacks its last element. */
export const isCutShort = (): boolean => document.getElementById("end") === null;

export function fail(sentence: string): void {
  const loading = document.getElementById("loading")!;
  document.getElementById("app")?.setAttribute("hidden", "");
  loading.hidden = false;
  loading.classList.add("failed");
  loading.setAttribute("role", "alert");
  document.getElementById("loading-text")!.textContent = sentence;
}
