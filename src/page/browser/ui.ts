// Small helpers for the page's controls.

/** The element of this id; it is in index.html. */
export function element<T extends HTMLElement = HTMLElement>(id: string): T {
  const found = document.getElementById(id);
  if (!found) throw new Error(`The page lacks its element '${id}'`);
  return found as T;
}

export const input = (id: string): HTMLInputElement => element<HTMLInputElement>(id);
export const select = (id: string): HTMLSelectElement => element<HTMLSelectElement>(id);

export function on(id: string, event: string, act: () => void): void {
  element(id).addEventListener(event, act);
}

/** An element with attributes and children; texts are never read as markup. */
export function make(
  tag: string, attributes: Record<string, string> = {}, ...children: (Node | string)[]): HTMLElement {
  const made = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) made.setAttribute(name, value);
  made.append(...children);
  return made;
}

/** Four digits. */
export function short(value: number): string {
  if (!Number.isFinite(value)) return "–";
  if (value === 0) return "0";
  const size = Math.abs(value);
  if (size < 1e-3 || size >= 1e6) return value.toExponential(2).replace("e+", "e");
  return Number(value.toPrecision(4)).toString();
}

/** A readable number, with all its digits for programs. */
export function number(value: number): HTMLElement {
  return make("data", { value: String(value) }, short(value));
}

/** A word as a shell reads it. */
export const quoted = (word: string): string => (/^[\w.-]+$/.test(word) ? word : `'${word.replaceAll("'", "'\\''")}'`);

export const counted = (count: number): string => count.toLocaleString("en");

/** Opens a panel and scrolls to it. */
export function unfold(id: string): void {
  element<HTMLDetailsElement>(id).open = true;
  element(id).scrollIntoView({ block: "nearest" });
}

/** Whether a key belongs to the browser. AltGr, which gives characters, is Ctrl and Alt in Windows. */
export function isShortcut(event: KeyboardEvent): boolean {
  return event.metaKey || ((event.ctrlKey || event.altKey) && !event.getModifierState("AltGraph"));
}

/** Whether keys are the picture's: it, or nothing, has the focus, so that they do not get in the way of typing. */
export function keysAreFree(): boolean {
  return document.activeElement === element("picture") || document.activeElement === document.body;
}

/** The value of the selected radio button of a group. */
export function onChoice(name: string, act: (value: string) => void): void {
  for (const radio of document.querySelectorAll<HTMLInputElement>(`input[name="${name}"]`)) {
    radio.addEventListener("change", () => radio.checked && act(radio.value));
  }
}

export function choose(name: string, value: string): void {
  document.querySelector<HTMLInputElement>(`input[name="${name}"][value="${value}"]`)?.click();
}

/** The value of an input or select as a text; 1 and 0 of a check box. */
export function valueOf(id: string): string {
  return input(id).type === "checkbox" ? String(Number(input(id).checked)) : input(id).value;
}

/** Gives a control that value, as if a person had. */
export function setTo(id: string, value: string): void {
  const control = input(id);
  if (valueOf(id) === value) return;
  if (control.type === "checkbox") control.checked = value === "1";
  else control.value = value;
  for (const event of ["input", "change"]) control.dispatchEvent(new Event(event, { bubbles: true }));
}

export async function copy(text: string, button: HTMLElement): Promise<void> {
  const label = button.textContent;
  try {
    await navigator.clipboard.writeText(text);
    button.textContent = "Copied";
  } catch {
    button.textContent = "Select the text to copy it"; // a page from a file may not be allowed to
  }
  setTimeout(() => { button.textContent = label; }, 2000);
}
