// A verb as a form, made from the table of its flags; its run; and its result.
import { allVerbs, begin, blob, cancel, get, listAnalyses, listRecordings, pause, type Analysis, type Asked, type Option, type OptionValue, type Page, type Recording, type RecordingList, type Section, type Table, type Verb } from "./api";
import { go, link, note, params } from "./address";
import { h, replace, save } from "./dom";
import { significant } from "./format";
import { notesList } from "./notes";
import { draw, fileName, saveSvg, type Drawn } from "./plot";
import { progress } from "./recording";
import type { View } from "./view";

const units: { [type: string]: string } = { HZ: "Hz", S: "s", M: "m", DEG: "°", V: "V", M_PER_S2: "m/s²", RPM: "rpm", UNIT: "", P: "" };

const title = (word: string): string => word.charAt(0).toUpperCase() + word.slice(1).replaceAll("-", " ");

const quote = (word: string): string => (/^[\w./=:,+-]+$/.test(word) ? word : `'${word.replaceAll("'", "'\\''")}'`);

/// As a person types it.
export function commandOf(asked: Asked): string {
  const words = ["proofmass", ...asked.verb.split(" "), ...asked.files];
  for (const [name, value] of Object.entries(asked.options)) {
    if (value === true) words.push(`--${name}`);
    else for (const one of Array.isArray(value) ? value : [value]) if (one !== false && one !== "") words.push(`--${name}`, String(one));
  }
  return words.map(quote).join(" ");
}

function tableOf(table: Table): HTMLElement {
  const rows = table.rows.map((row) => h("tr", {}, ...row.map((cell, k) => (k === 0 ? h("th", { scope: "row" }, cell) : h("td", {}, cell)))));
  const more = table.rows_in_all > table.rows.length ? ` The first ${table.rows.length} of ${table.rows_in_all}; the JSON document has all.` : "";
  return h(
    "div",
    { class: "wide", tabindex: "0" },
    h("table", {}, h("caption", {}, table.caption + more), table.head.length > 0 && h("thead", {}, h("tr", {}, ...table.head.map((cell) => h("th", { scope: "col" }, cell)))), h("tbody", {}, ...rows)),
  );
}

/// The verb's own page, with live plots. `run` is the analysis that the downloads come from.
function resultOf(page: Page, run: Analysis, plots: Drawn[]): HTMLElement[] {
  let figures = 0;
  const section = (one: Section): HTMLElement => {
    const body: HTMLElement[] = [
      ...one.sides.map((side) => h("p", {}, h("b", { class: "strong" }, side.label), " ", side.text)),
      ...one.paragraphs.map((text) => h("p", {}, text)),
    ];
    if (one.points.length > 0) body.push(h("ul", {}, ...one.points.map((text) => h("li", {}, text))));
    const drawn = one.figures.map((figure) => {
      const index = figures++;
      const actions: { name: string; act: () => void }[] = [];
      const plot = draw(figure, { actions });
      plots.push(plot);
      const svg = { name: "SVG", act: () => void saveSvg(`/api/analyses/${run.id}/report.html`, index, fileName(figure.title)) };
      return h(
        "section",
        { class: "panel", "aria-label": figure.title },
        h("div", { class: "ph" }, h("h3", {}, figure.title), h("span", { class: "soft" }, "drag zooms, double click resets"), h("span", { class: "r" }, ...[svg, ...actions].map((action) => h("button", { type: "button", class: "btn small", onclick: action.act, "aria-label": `${figure.title} as ${action.name}` }, action.name)))),
        h("div", { class: "pb" }, plot.element, h("p", { class: "soft" }, figure.description)),
      );
    });
    return h("section", { class: "section" }, h("h2", {}, one.heading), ...drawn, ...one.tables.map(tableOf), ...body, ...one.parts.map(section));
  };
  return [
    h("p", { class: "conclusion" }, page.conclusion),
    ...(page.key_figures.length > 0 ? [h("dl", { class: "key" }, ...page.key_figures.map((figure) => h("div", {}, h("dt", {}, figure.label), h("dd", {}, figure.value))))] : []),
    notesList(page.notes, 4),
    ...page.sections.map(section),
  ];
}

interface Exported {
  format: string;
  text: string;
}

/// A file that the verb writes in place of a page.
function textOf(made: Exported, run: Analysis): HTMLElement[] {
  const name = `${(run.files[0] ?? "sensor").split("/").at(-1)?.replace(/\.toml$/, "")}.${made.format === "c-header" ? "h" : "yaml"}`;
  const download = h("button", { type: "button", class: "btn", onclick: () => save(name, new Blob([made.text], { type: "text/plain" })) }, `Download ${name}`);
  return [h("p", { class: "bar" }, download), h("pre", { class: "wide", tabindex: "0" }, made.text)];
}

interface Field {
  name: string;
  value: () => OptionValue;
  element: HTMLElement;
}

function valueIn(address: { [name: string]: string }, option: Option): string {
  return address[`o.${option.name}`] ?? "";
}

// One field of the form. What differs from the default gets an edge.
function fieldOf(option: Option, address: { [name: string]: string }, list: RecordingList, channels: string[], changed: () => void): Field {
  const id = `option-${option.name}`;
  const given = valueIn(address, option);
  let control: HTMLElement;
  let value: () => OptionValue;
  const help = h("div", { class: "help", id: `${id}-help` }, `${option.help}. `, h("code", {}, `--${option.name}`));
  const about = { id, "aria-describedby": `${id}-help` };
  if (option.switch) {
    const box = h("input", { ...about, type: "checkbox" });
    box.checked = given === "true";
    value = () => box.checked;
    control = box;
  } else if (option.name === "channel" && channels.length > 0) {
    const wanted = new Set(given.split("\n").filter((word) => word !== ""));
    const boxes = channels.map((name) => {
      const box = h("input", { type: "checkbox", value: name });
      box.checked = wanted.has(name);
      return box;
    });
    value = () => boxes.filter((box) => box.checked).map((box) => box.value);
    control = h("span", { id, class: "in many", role: "group", "aria-label": "Channels; none chosen: all" }, ...boxes.map((box) => h("label", {}, box, box.value)));
  } else if (option.choices.length > 0 || option.file) {
    const names = option.file ? [...(option.type.includes("toml") ? list.sensor_files : list.recordings.map((one) => one.name))] : option.choices;
    const none = option.file ? "none" : option.default ? `${option.default} (default)` : "default";
    const select = h("select", about, h("option", { value: "" }, none), ...names.map((name) => h("option", { value: name }, name)));
    if (names.includes(given)) select.value = given;
    value = () => select.value;
    control = select;
  } else {
    const input = h("input", { ...about, type: "text", placeholder: option.default || (option.required ? "required" : ""), autocomplete: "off", inputmode: /^(HZ|S|M|DEG|V|N|P|X|MB)/.test(option.type) ? "decimal" : "text" });
    input.value = given.replaceAll("\n", ", ");
    value = () => (option.many ? input.value.split(",").map((word) => word.trim()).filter((word) => word !== "") : input.value.trim());
    const unit = units[option.type] ?? "";
    control = unit ? h("span", { class: "in" }, input, h("span", { class: "unit", "aria-hidden": "true" }, unit)) : input;
  }
  const isSet = (): boolean => {
    const now = value();
    return Array.isArray(now) ? now.length > 0 : now !== "" && now !== false;
  };
  const name = option.name === "channel" ? "Channels" : title(option.name);
  const label = option.name === "channel" && channels.length > 0 ? h("span", { class: "label" }, name) : h("label", { for: id }, name);
  const element = h("div", { class: "f" }, label, control.classList.contains("in") ? control : h("span", { class: "in" }, control), help);
  const mark = (): void => void element.classList.toggle("changed", isSet());
  element.addEventListener("input", () => {
    mark();
    changed();
  });
  mark();
  return { name: option.name, value, element };
}

const first = ["channel", "from", "to"];

export function analysisView(main: HTMLElement): View {
  let ended = false;
  let verb: Verb | undefined;
  let fields: Field[] = [];
  let files: string[] = (params()["file"] ?? "").split("\n").filter((name) => name !== "");
  let list: RecordingList = { recordings: [], sensor_files: [], left: 0 };
  let running: number | undefined;
  const plots: Drawn[] = [];
  const head = h("div", { class: "head" });
  const form = h("form", { class: "panel form", "aria-label": "Settings" });
  const result = h("div", {});
  const status = h("div", { role: "status" });
  const command = h("p", { class: "command" });
  const run = h("button", { type: "submit", class: "btn main" }, "Run ", h("kbd", { class: "keys" }, "Ctrl ↵"));
  const sensorBox = h("input", { type: "checkbox", id: "make-sensor-file" });
  // On a phone the form folds once there is a result.
  const settings = h("details", { class: "settings", open: true }, h("summary", {}, "Settings"), form);
  replace(main, head, h("div", { class: "ana" }, settings, h("div", {}, status, result)));

  function asked(): Asked {
    const options: Asked["options"] = {};
    for (const field of fields) {
      const value = field.value();
      if (Array.isArray(value) ? value.length > 0 : value !== "" && value !== false) options[field.name] = value;
    }
    return { verb: verb?.name ?? "", files, options, sensor_file: sensorBox.checked };
  }
  // Form and files are in the address.
  function changed(): void {
    const change: { [name: string]: string } = {};
    for (const field of fields) {
      const value = field.value();
      change[`o.${field.name}`] = Array.isArray(value) ? value.join("\n") : value === false ? "" : String(value);
    }
    note({ ...change, verb: verb?.name ?? "", file: files.join("\n") });
    command.textContent = commandOf(asked());
    run.disabled = files.length === 0;
    if (result.childElementCount > 0 && running === undefined) result.classList.add("stale");
  }

  function titleLine(analysis?: Analysis): void {
    const name = files[0] ?? "";
    const downloads: (HTMLElement | false)[] = [];
    if (analysis?.state === "done") {
      const base = `${name.split("/").at(-1) ?? "result"}-${analysis.verb.replaceAll(" ", "-")}`;
      const labels: { [file: string]: string } = { "report.html": "Report", "result.json": "JSON", "series.csv": "CSV", "sensor.toml": "Sensor file" };
      for (const [made, label] of Object.entries(labels))
        if (analysis.files_made.includes(made))
          downloads.push(h("button", { type: "button", class: "btn", onclick: () => void blob(`/api/analyses/${analysis.id}/${made}`).then((got) => save(`${base}${made === "report.html" ? ".html" : made === "result.json" ? ".json" : made === "series.csv" ? ".csv" : ".toml"}`, got)) }, label));
      if (verb?.page) downloads.push(h("a", { class: "btn", ...link({ v: "compare", runs: String(analysis.id) }) }, "Compare… ", h("kbd", { class: "keys" }, "c")));
    }
    replace(
      head,
      h("a", { ...(name && verb?.reads === "recordings" ? link({ v: "recording", file: name }) : link({ v: "analysis" })) }, name && verb?.reads === "recordings" ? `‹ ${name}` : "‹ Analyses"),
      h("h1", {}, title(verb?.name ?? "")),
      h("span", { class: "soft" }, verb?.help ?? ""),
      h("div", { class: "acts" }, downloads.length > 0 && h("span", { class: "soft" }, "Download"), ...downloads),
    );
  }

  const fileWord = (): string => (verb?.reads === "sensor_files" ? "Sensor file" : "Recording");
  function filesField(): HTMLElement {
    const names = verb?.reads === "sensor_files" ? list.sensor_files : list.recordings.map((one) => one.name);
    const select = (index: number): HTMLElement => {
      const box = h("select", { "aria-label": index === 0 ? fileWord() : `${fileWord()} ${index + 1}` }, h("option", { value: "" }, index === 0 ? "choose…" : "no more"), ...names.map((name) => h("option", { value: name }, name)));
      box.value = files[index] ?? "";
      box.addEventListener("change", () => {
        if (box.value) files[index] = box.value;
        else files.splice(index, 1);
        build();
        titleLine();
      });
      return h("div", { class: "f" }, h("span", { class: "label" }, index === 0 ? "File" : `File ${index + 1}`), h("span", { class: "in" }, box));
    };
    const shown = verb?.many_files ? files.length + 1 : 1;
    return h("div", {}, ...Array.from({ length: Math.max(1, shown) }, (_, k) => select(k)));
  }

  function build(): void {
    if (!verb) return;
    const one = verb;
    const address = params();
    const recording: Recording | undefined = list.recordings.find((each) => each.name === files[0]);
    const channels = (recording?.summary?.channels ?? []).map((channel) => channel.name);
    const made = one.options.map((option) => ({ option, field: fieldOf(option, address, list, channels, changed) }));
    fields = made.map((each) => each.field);
    const group = (name: string): HTMLElement[] => made.filter((each) => each.option.group === name && !first.includes(each.option.name)).map((each) => each.field.element);
    const groups = [...new Set(made.map((each) => each.option.group))].filter((name) => name !== "Input");
    const input = group("Input");
    const inputIsSet = input.some((element) => element.classList.contains("changed"));
    replace(
      form,
      h("fieldset", {}, h("legend", {}, fileWord()), filesField(), ...made.filter((each) => first.includes(each.option.name)).sort((a, b) => first.indexOf(a.option.name) - first.indexOf(b.option.name)).map((each) => each.field.element)),
      ...groups.map((name) => {
        const elements = group(name);
        return elements.length > 0 && h("fieldset", {}, h("legend", {}, name === "Options" || name === "OPTIONS" ? title(one.name) : name), ...elements);
      }),
      input.length > 0 && h("fieldset", {}, h("details", { open: inputIsSet }, h("summary", {}, `How the recording is read: ${input.length} settings`), ...input)),
      one.sensor_file && h("fieldset", {}, h("div", { class: "f" }, h("label", { for: "make-sensor-file" }, "Sensor file"), h("span", { class: "in" }, sensorBox, h("span", { class: "soft" }, "make one to download")))),
      h("div", { class: "foot" }, command, h("div", { class: "run-line" }, run, h("button", { type: "button", class: "btn", onclick: () => void navigator.clipboard?.writeText(command.textContent ?? "") }, "Copy command"))),
    );
    changed();
  }

  async function showResult(analysis: Analysis): Promise<void> {
    while (plots.length > 0) plots.pop()?.dispose();
    result.classList.remove("stale");
    const messages = analysis.messages.length > 0 && h("details", {}, h("summary", {}, `${analysis.messages.length} lines that the program printed`), h("pre", { class: "wide", tabindex: "0" }, analysis.messages.join("\n")));
    if (analysis.state !== "done") {
      replace(result, h("div", { class: "failure", role: "alert" }, h("p", { class: "strong" }, analysis.state === "cancelled" ? "Cancelled" : `${title(analysis.verb)} failed`), h("p", {}, analysis.error ?? "It was stopped before it had a result."), h("p", { class: "bar" }, h("button", { type: "button", class: "btn", onclick: () => void start() }, "Run again"))), messages);
      return;
    }
    const shown = verb?.page ? resultOf(await get<Page>(`/api/analyses/${analysis.id}/page.json`), analysis, plots) : textOf(await get<Exported>(`/api/analyses/${analysis.id}/result.json`), analysis);
    if (ended) return;
    if (matchMedia("(max-width: 700px)").matches) settings.open = false;
    replace(result, ...shown, messages);
    titleLine(analysis);
  }

  async function follow(id: number): Promise<void> {
    running = id;
    note({ run: String(id) });
    if (result.childElementCount > 0) result.classList.add("stale");
    while (!ended && running === id) {
      const now = await get<Analysis>(`/api/analyses/${id}`);
      if (ended || running !== id) return;
      if (now.state !== "waiting" && now.state !== "running") {
        running = undefined;
        replace(status, now.state === "done" && h("p", { class: "soft" }, `done in ${significant(now.seconds, 2)} s`));
        await showResult(now);
        return;
      }
      replace(
        status,
        h("p", { class: "bar" }, h("span", {}, now.state === "waiting" ? "waits for another run" : now.stage || "running"), progress(now.fraction), h("span", { class: "soft" }, `${Math.round(100 * now.fraction)} %, ${significant(now.seconds, 2)} s`), h("button", { type: "button", class: "btn", onclick: () => void cancel(id) }, "Cancel")),
      );
      await pause(250);
    }
  }

  async function start(): Promise<void> {
    if (files.length === 0) return;
    try {
      await follow(await begin(asked()));
    } catch (problem) {
      running = undefined;
      replace(status, h("p", { class: "failure", role: "alert" }, problem instanceof Error ? problem.message : String(problem)));
    }
  }

  async function open(): Promise<void> {
    const verbs = await allVerbs();
    list = await listRecordings();
    verb = verbs.find((one) => one.name === params()["verb"]);
    if (ended) return;
    if (!verb) return analysesList(verbs);
    const id = Number(params()["run"] ?? 0);
    titleLine();
    build();
    if (id > 0) await follow(id).catch(() => note({ run: "" }));
    else if (verb.options.length === 0 && !verb.many_files) await start();
    // Channels are known once the recording has been inspected.
    while (!ended && list.recordings.find((one) => one.name === files[0])?.summary === null) {
      await pause(700);
      list = await listRecordings();
      if (!ended && list.recordings.find((one) => one.name === files[0])?.summary) build();
    }
  }

  async function analysesList(verbs: Verb[]): Promise<void> {
    const runs = await listAnalyses();
    if (ended) return;
    const recording = params()["file"] ?? "";
    const groups = [...new Set(verbs.map((one) => one.group))];
    replace(
      main,
      h("div", { class: "head" }, h("h1", {}, "Analyses"), h("span", { class: "soft" }, recording ? `of ${recording}` : "of the recordings of this folder")),
      ...groups.map((group) => h("section", { class: "panel" }, h("div", { class: "ph" }, h("h2", {}, group)), h("div", { class: "pb bar" }, ...verbs.filter((one) => one.group === group).map((one) => h("a", { class: "btn", title: one.help, ...link({ v: "analysis", verb: one.name, file: recording }) }, title(one.name), h("span", { class: "soft" }, one.help)))))),
      h(
        "section",
        { class: "panel" },
        h("div", { class: "ph" }, h("h2", {}, "Runs"), h("span", { class: "soft" }, "kept until serve ends")),
        h(
          "div",
          { class: "pb wide", tabindex: "0" },
          runs.length === 0
            ? h("p", { class: "soft" }, "None yet.")
            : h("table", { class: "runs" }, h("thead", {}, h("tr", {}, ...["Run", "State", "Time", "Command"].map((word) => h("th", { scope: "col" }, word)))), h("tbody", {}, ...runs.reverse().map((one) => h("tr", {}, h("th", { scope: "row" }, h("a", { ...link(addressOf(one)) }, `${one.id} ${title(one.verb)}`)), h("td", { class: one.state === "failed" ? "red" : "" }, one.state), h("td", {}, one.seconds > 0 ? `${significant(one.seconds, 2)} s` : "–"), h("td", {}, one.command))))),
        ),
      ),
    );
  }

  form.addEventListener("submit", (event) => {
    event.preventDefault();
    void start();
  });
  open().catch((problem: unknown) => replace(status, h("p", { class: "failure" }, problem instanceof Error ? problem.message : String(problem))));

  return {
    dispose: () => {
      ended = true;
      for (const one of plots) one.dispose();
    },
    key: (key, event) => {
      if (key === "Enter" && event.ctrlKey) void start();
      else if (key === "Escape" && running !== undefined) void cancel(running);
      else if (key === "Escape") go({ v: "analysis" });
      else if (key === "c" && params()["run"]) go({ v: "compare", runs: params()["run"] ?? "" });
      else return false;
      return true;
    },
  };
}

/// Where a run is looked at, with its form.
export function addressOf(run: Analysis): { [name: string]: string } {
  const address: { [name: string]: string } = { v: "analysis", verb: run.verb, file: run.files.join("\n"), run: String(run.id) };
  for (const [name, value] of Object.entries(run.options)) address[`o.${name}`] = Array.isArray(value) ? value.join("\n") : String(value);
  return address;
}
