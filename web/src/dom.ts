// Elements made in one call; texts from files only ever become text.

type Child = Node | string | null | undefined | false;
type Attributes = Record<string, unknown>;

/** An element with attributes (`on...` are listeners, `true` is present, false and null absent) and children. */
export function h<K extends keyof HTMLElementTagNameMap>(
  tag: K,
  attributes: Attributes = {},
  ...children: Child[]
): HTMLElementTagNameMap[K] {
  const element = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) {
    if (value === false || value === null || value === undefined) continue;
    if (name.startsWith("on") && typeof value === "function") {
      element.addEventListener(name.slice(2), value as EventListener);
    } else if (name === "value" || name === "checked" || name === "disabled" || name === "selected") {
      (element as unknown as Attributes)[name] = value;
    } else {
      element.setAttribute(name, value === true ? "" : String(value));
    }
  }
  put(element, ...children);
  return element;
}

/** Replaces what is in an element. Where it is the same already nothing is touched: a button that is put anew while it is pressed loses the click. */
export function put(element: Element, ...children: Child[]): void {
  const there = children.filter((child): child is Node | string => child !== null && child !== undefined && child !== false);
  const wanted = there.map((child) => (typeof child === "string" ? cleaned(child) : child));
  const own = element.childNodes;
  if (wanted.length === own.length && wanted.every((child, place) => child === own[place])) return;
  element.replaceChildren(...wanted);
}

/** Text as it is: names from files may hold marks that turn the text around them, or control it. */
export function cleaned(text: string): string {
  return text.replace(/[\p{Bidi_Control}\x00-\x08\x0b-\x1f\x7f-\x9f]/gu, "\ufffd");
}

let ids = 0;

/** A control with its label above it. */
export function field(label: string, control: HTMLElement, hint?: string): HTMLElement {
  ids += 1;
  control.id ||= `field-${ids}`;
  if (hint) control.setAttribute("aria-describedby", `${control.id}-hint`);
  return h(
    "div",
    { class: "field" },
    h("label", { for: control.id }, label),
    control,
    hint ? h("small", { id: `${control.id}-hint` }, hint) : null,
  );
}

/** A choice of one. */
export function choice(options: [value: string, label: string][], value: string, onchange: (value: string) => void): HTMLSelectElement {
  const select = h("select", { onchange: () => onchange(select.value) });
  put(select, ...options.map(([own, label]) => h("option", { value: own, selected: own === value }, label)));
  return select;
}

/** Warnings, or what was found, with their codes. */
export function warned(all: { code: string; message: string; severity?: string }[]): HTMLElement {
  return h("ul", { class: "findings" }, ...all.map((one) => h("li", { class: one.severity ?? "warning" }, h("code", {}, one.code), h("span", {}, one.message))));
}

/** How long a note stays, ms; an error stays until it is closed. */
const NOTE_STAYS = 10_000;

/** Says something to who sees the page and to who hears it. */
export function say(text: string, kind: "note" | "error" = "note"): void {
  const place = document.getElementById("said");
  if (!place) return;
  const toast = h("div", { class: `toast ${kind}` }, h("span", {}, text), h("button", { class: "quiet", "aria-label": "Close this message", onclick: () => toast.remove() }, "×"));
  put(place, toast);
  if (kind === "note") window.setTimeout(() => toast.remove(), NOTE_STAYS);
}

/** Does something, and says what went wrong with it. */
export async function attempt<T>(work: () => Promise<T>): Promise<T | undefined> {
  try {
    return await work();
  } catch (error) {
    if (error instanceof DOMException && error.name === "AbortError") return undefined;
    say(error instanceof Error ? error.message : String(error), "error");
    return undefined;
  }
}
