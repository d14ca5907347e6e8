import type { Note } from "./api";
import { h } from "./dom";

const rank = { bad: 0, warning: 1, info: 2 };

/// The gravest first, the first few; the rest on demand.
export function notesList(notes: Note[], most: number): HTMLElement {
  const sorted = [...notes].sort((a, b) => rank[a.severity] - rank[b.severity]);
  const item = (one: Note): HTMLElement => h("li", { class: one.severity }, h("b", {}, one.severity === "info" ? "note" : one.severity), ` ${one.text}`);
  const list = h("ul", { class: "notes" }, ...sorted.slice(0, most).map(item));
  if (sorted.length > most) {
    const more = h("button", { type: "button", class: "btn small" }, `${sorted.length - most} more`);
    more.addEventListener("click", () => list.replaceChildren(...sorted.map(item)));
    list.append(h("li", {}, more));
  }
  return list;
}
