// Elements without markup in strings: no text can become markup.

type Child = Node | string | null | undefined | false;
type Props = { [name: string]: unknown };

function set(element: Element, name: string, value: unknown): void {
  if (value === undefined || value === null || value === false) return;
  if (name.startsWith("on") && typeof value === "function") {
    element.addEventListener(name.slice(2), value as EventListener);
  } else if (value === true) {
    element.setAttribute(name, "");
  } else {
    element.setAttribute(name, String(value));
  }
}

export function h<K extends keyof HTMLElementTagNameMap>(
  tag: K,
  props: Props = {},
  ...children: Child[]
): HTMLElementTagNameMap[K] {
  const element = document.createElement(tag);
  for (const [name, value] of Object.entries(props)) set(element, name, value);
  append(element, children);
  return element;
}

export function svg(tag: string, props: Props = {}, ...children: Child[]): SVGElement {
  const element = document.createElementNS("http://www.w3.org/2000/svg", tag) as SVGElement;
  for (const [name, value] of Object.entries(props)) set(element, name, value);
  append(element, children);
  return element;
}

function append(element: Element, children: Child[]): void {
  for (const child of children) if (child !== null && child !== undefined && child !== false) element.append(child);
}

export function replace(element: Element, ...children: Child[]): void {
  element.replaceChildren();
  append(element, children);
}

/// A colour of the style sheet, for canvases.
export function colour(name: string): string {
  return getComputedStyle(document.documentElement).getPropertyValue("--" + name).trim();
}

export function save(name: string, blob: Blob): void {
  const url = URL.createObjectURL(blob);
  h("a", { href: url, download: name }).click();
  setTimeout(() => URL.revokeObjectURL(url), 10_000);
}

export type Light = "good" | "warning" | "bad" | "unreadable" | "none" | "harmless";

/// Shape, colour and word, so that no one of them has to be seen.
export function light(kind: Light, word: string, hidden = false): HTMLElement {
  const shapes: Record<Light, SVGElement> = {
    good: svg("circle", { cx: 5, cy: 5, r: 4 }),
    warning: svg("path", { d: "M5 1l4.5 8h-9z" }),
    bad: svg("rect", { x: 1, y: 1, width: 8, height: 8 }),
    unreadable: svg("path", { d: "M2 2l6 6M8 2l-6 6", class: "stroke" }),
    none: svg("circle", { cx: 5, cy: 5, r: 3.5, class: "hollow" }),
    harmless: svg("circle", { cx: 5, cy: 5, r: 3.5, class: "hollow" }),
  };
  const mark = svg("svg", { viewBox: "0 0 10 10", class: "light-mark " + kind, "aria-hidden": "true" }, shapes[kind]);
  return h("span", { class: "light" }, mark, h("span", { class: hidden ? "only-heard" : "" }, word));
}
