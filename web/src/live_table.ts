// The list of live sources, with the lights of each.
import { h, light, replace, type Light } from "./dom";
import { count, duration, significant } from "./format";
import type { Source } from "./live_api";

export interface TableActions {
  choose: (id: number) => void;
  stop: (source: Source) => void;
  record: (source: Source) => void;
  forget: (source: Source) => void;
}

const is = (source: Source): boolean => source.state === "running" || source.state === "ending" || source.state === "opening";

function jitterWords(seconds: number | null): string {
  if (seconds === null) return "–";
  return seconds < 1e-3 ? `${significant(1e6 * seconds, 2)} µs` : `${significant(1e3 * seconds, 2)} ms`;
}

function silenceLight(source: Source): [Light, string] {
  const silence = source.last_state?.silence_s;
  if (!is(source) || silence === undefined || silence === null) return ["none", "–"];
  if (silence > 2) return ["bad", `nothing for ${significant(silence, 2)} s`];
  return ["good", `${Math.round(1000 * silence)} ms`];
}

/// Lights of loss, gaps, jitter, clipping and silence.
export function lightsOf(source: Source): [string, Light, string][] {
  const state = source.last_state;
  const clipped = source.last_audit?.channels.reduce((sum, one) => sum + one.clipped, 0);
  const counted = (value: number | undefined, kind: Light): [Light, string] => (value === undefined ? ["none", "–"] : value > 0 ? [kind, count(value)] : ["good", "0"]);
  const rate = source.last_head?.rate_hz;
  const jitter = source.last_audit?.jitter_s;
  const isUneven = jitter !== undefined && jitter !== null && rate !== undefined && rate !== null && jitter * rate > 0.1;
  return [
    ["Loss", ...counted(state?.lost, "bad")],
    ["Gaps", ...counted(state?.gaps, "warning")],
    ["Jitter", jitter === undefined || jitter === null ? "none" : isUneven ? "warning" : "good", jitterWords(jitter ?? null)],
    ["Clipping", ...counted(clipped, "bad")],
    ["Silence", ...silenceLight(source)],
  ];
}

export function recorderWords(source: Source): HTMLElement {
  const time = source.last_end?.duration_s ?? source.last_state?.time_s ?? 0;
  if (source.state === "failed") return h("span", { class: "red" }, source.error ?? "failed");
  if (source.state === "opening") return h("span", { class: "soft" }, "being opened…");
  if (source.state === "ended") return h("span", { class: "soft" }, source.file && source.last_end?.files.length ? `${source.last_end.files.join(", ")}, ${duration(time)}, lost ${count(source.last_end.lost)}` : "ended, no file");
  if (!source.file) return h("span", { class: "soft" }, `no file, ${duration(time)}`);
  return h("span", {}, h("b", { class: "red" }, `● ${duration(time)}`), ` ${source.file}, lost ${count(source.last_state?.lost ?? 0)}`);
}

function buttons(source: Source, actions: TableActions): HTMLElement {
  const button = (word: string, act: () => void, className = ""): HTMLElement => h("button", { type: "button", class: `btn small ${className}`, onclick: (event: Event) => { event.stopPropagation(); act(); }, "aria-label": `${word} ${source.source}` }, word);
  return h(
    "span",
    { class: "acts" },
    source.state === "running" && !source.file && button("● Record", () => actions.record(source)),
    source.state === "ending" ? h("span", { class: "soft" }, "closing…") : is(source) ? button("■ Stop", () => actions.stop(source), source.file ? "recording" : "") : button("Forget", () => actions.forget(source)),
  );
}

export function sourcesTable(at: HTMLElement, sources: Source[], selected: number | undefined, leftOut: number, actions: TableActions): void {
  const head = ["Source", "Rate × channels", "Loss", "Gaps", "Jitter", "Clipping", "Silence", "View", "Recorder", ""];
  const rows = sources.map((source) => {
    const channels = source.last_head?.channels.length ?? 0;
    const rate = source.last_head?.rate_hz;
    const isSelected = source.id === selected;
    const choose = h("button", { type: "button", class: "link", "aria-pressed": String(isSelected), onclick: () => actions.choose(source.id) }, source.source);
    const view = isSelected ? (leftOut > 0 ? light("harmless", `${count(leftOut)} frames left out`) : light("good", "all")) : light("none", "–");
    return h(
      "tr",
      { class: isSelected ? "on" : "", "data-source": source.id },
      h("th", { scope: "row" }, choose),
      h("td", { class: "num", "data-label": "Rate" }, `${rate ? `${significant(rate, 4)} Hz` : "–"} × ${channels}`),
      ...lightsOf(source).map(([name, kind, word]) => h("td", { "data-label": name }, light(kind, word))),
      h("td", { "data-label": "View" }, view),
      h("td", { class: "recorder" }, recorderWords(source)),
      h("td", { class: "num" }, buttons(source, actions)),
    );
  });
  replace(at, h("table", { class: "sources" }, h("thead", {}, h("tr", {}, ...head.map((word, k) => h("th", { scope: "col", class: k === 1 ? "num" : "" }, word || h("span", { class: "only-heard" }, "Actions"))))), h("tbody", {}, ...rows)));
}
