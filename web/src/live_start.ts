// The form that starts a source: what is there, what is estimated, and into which file.
import { post } from "./api";
import { h, replace } from "./dom";
import { findSources, type Found } from "./live_api";

let found: Found | undefined;

export interface StartOptions {
  procedure?: boolean; ///< a guided procedure in place of an estimate
  started: (id: number) => void;
  source?: string;
}

const field = (name: string, control: HTMLElement, help = ""): HTMLElement => h("div", { class: "f" }, h("label", { for: control.id }, name), h("div", { class: "in" }, control), help !== "" && h("div", { class: "help always" }, help));

function choice(id: string, words: [string, string][]): HTMLSelectElement {
  return h("select", { id }, ...words.map(([value, word]) => h("option", { value }, word)));
}

export function startForm(options: StartOptions): HTMLElement {
  const list = h("datalist", { id: "sources-found" });
  const source = h("input", { id: "live-source", list: "sources-found", value: options.source ?? (options.procedure ? "sim:multi-position" : "sim:wheel"), spellcheck: "false", autocomplete: "off" });
  const kinds = h("div", { class: "kinds" });
  const what = options.procedure
    ? choice("live-what", [["multi-position", "All over the sphere, by hand"], ["tumble", "Tumble, on a turntable"]])
    : choice("live-what", [["", "nothing"], ["wheel", "wheel: angle and speed"], ["tilt", "tilt: roll and pitch"], ["track", "track: displacement"]]);
  const unit = choice("live-unit", [["", "as the source states"], ["g", "g"], ["mg", "mg"], ["m/s2", "m/s²"], ["V", "V"], ["mV", "mV"], ["counts", "counts"]]);
  const target = h("input", { id: "live-target", value: "1", inputmode: "decimal" });
  const sendTo = h("input", { id: "live-send-to", placeholder: "udp:127.0.0.1:5005", spellcheck: "false", autocomplete: "off" });
  const sendField = field("Send to", sendTo, "each estimate as a datagram of JSON, for a controller on this machine");
  what.addEventListener("change", () => (sendField.hidden = what.value === ""));
  sendField.hidden = true;
  const file = h("input", { id: "live-file", placeholder: "named by source and time", spellcheck: "false", autocomplete: "off" });
  const said = h("div", { role: "status" });
  const begin = async (recorded: boolean): Promise<void> => {
    const words: { [name: string]: string } = {};
    if (what.value !== "") words[options.procedure ? "procedure" : "estimate"] = what.value;
    if (unit.value !== "") words["unit"] = unit.value;
    if (!options.procedure && what.value !== "" && sendTo.value.trim() !== "") words["send-to"] = sendTo.value.trim();
    if (options.procedure && target.value !== "") words["target-std"] = target.value;
    try {
      const made = await post<{ id: number }>("/api/live", { source: source.value.trim(), file: recorded ? file.value.trim() : null, options: words });
      options.started(made.id);
    } catch (problem) {
      replace(said, h("p", { class: "failure" }, problem instanceof Error ? problem.message : String(problem)));
    }
  };
  const show = (): void => {
    if (!found) return;
    replace(list, ...found.found.map((one) => h("option", { value: one.uri }, one.what)));
    replace(kinds, h("details", {}, h("summary", {}, `${found.found.length} found; all kinds of source`), h("table", {}, h("tbody", {}, ...found.found.map((one) => h("tr", {}, h("th", { scope: "row" }, h("button", { type: "button", class: "link", onclick: () => (source.value = one.uri) }, one.uri)), h("td", {}, one.what))), ...found.kinds.map((one) => h("tr", {}, h("th", { scope: "row" }, one.grammar), h("td", {}, one.what)))))));
  };
  const look = async (): Promise<void> => {
    replace(kinds, h("p", { class: "soft" }, "looking for sources…"));
    try {
      found = await findSources();
      show();
    } catch (problem) {
      replace(kinds, h("p", { class: "soft" }, problem instanceof Error ? problem.message : String(problem)));
    }
  };
  if (found) show();
  else void look();
  return h(
    "form",
    { class: "panel start", "aria-label": "Start a source", onsubmit: (event: Event) => { event.preventDefault(); void begin(options.procedure === true); } },
    h("div", { class: "ph" }, h("h2", {}, options.procedure ? "Begin a calibration" : "Add a source"), h("span", { class: "r" }, h("button", { type: "button", class: "btn small", onclick: () => void look() }, "Look again"))),
    h(
      "div",
      { class: "pb fields" },
      list,
      field("Source", source),
      field(options.procedure ? "Procedure" : "Estimate", what),
      !options.procedure && sendField,
      field("Unit", unit),
      options.procedure && field("Target (mg)", target, "standard deviation of a calibrated measurement at 1 g"),
      field("File", file),
    ),
    kinds,
    h(
      "div",
      { class: "run-line" },
      !options.procedure && h("button", { type: "submit", class: "btn" }, "Watch only"),
      h("button", { type: "button", class: "btn main", onclick: () => void begin(true) }, options.procedure ? "Begin" : "● Record"),
      said,
    ),
  );
}
