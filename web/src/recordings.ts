// The folder as a list, with what `inspect` says of each recording.
import { ApiError, listRecordings, pause, upload, type Recording, type RecordingList, type Thumbnail } from "./api";
import { go, link, note, params } from "./address";
import { colour, h, light, replace, type Light } from "./dom";
import { bytes, count, day, duration, plain, significant } from "./format";
import { channelInk } from "./inks";
import { notesList } from "./notes";
import type { View } from "./view";

function lightOf(recording: Recording): [Light, string] {
  if (recording.state === "failed") return ["unreadable", "cannot be read"];
  if (!recording.summary) return ["none", "not inspected yet"];
  const faults = recording.summary.notes.filter((one) => one.severity === "bad").length;
  const warnings = recording.summary.notes.filter((one) => one.severity === "warning").length;
  if (faults > 0) return ["bad", `${faults} ${faults === 1 ? "fault" : "faults"} in the data`];
  if (warnings > 0) return ["warning", `${warnings} ${warnings === 1 ? "thing" : "things"} to know`];
  return ["good", "nothing wrong with it"];
}

export function drawThumbnails(canvas: HTMLCanvasElement, curves: Thumbnail[], inks: string[]): void {
  const width = canvas.clientWidth;
  const height = canvas.clientHeight;
  const context = canvas.getContext("2d");
  if (!context || width === 0) return;
  canvas.width = width * devicePixelRatio;
  canvas.height = height * devicePixelRatio;
  context.scale(devicePixelRatio, devicePixelRatio);
  const all = curves.flatMap((curve) => [...curve.min, ...curve.max]).filter((value): value is number => value !== null);
  const low = Math.min(...all);
  const high = Math.max(...all);
  const y = (value: number): number => height - 2 - (high > low ? (value - low) / (high - low) : 0.5) * (height - 4);
  curves.forEach((curve, k) => {
    context.strokeStyle = colour(inks[k] ?? "blue");
    context.lineWidth = 1;
    context.beginPath();
    let before: number | null = null;
    curve.min.forEach((min, column) => {
      const max = curve.max[column];
      if (min === null || max === null || max === undefined) return;
      const x = ((column + 0.5) / curve.min.length) * width;
      if (before !== null) context.lineTo(x, y((min + max) / 2));
      context.moveTo(x, y(min) + 0.5);
      context.lineTo(x, y(max) - 0.5);
      before = (min + max) / 2;
    });
    context.stroke();
  });
}

const matches = (recording: Recording, filter: string): boolean =>
  filter
    .toLowerCase()
    .split(/\s+/)
    .every((word) => {
      const compared = /^(rate|length|channels|gaps|clipped)([<>])([\d.]+)$/.exec(word);
      if (compared) {
        const summary = recording.summary;
        if (!summary) return false;
        const figures: { [name: string]: number } = { rate: summary.rate_hz ?? 0, length: summary.duration_s, channels: summary.channels.length, gaps: summary.gaps, clipped: summary.clipped };
        const value = figures[compared[1] as string] ?? 0;
        return compared[2] === ">" ? value > Number(compared[3]) : value < Number(compared[3]);
      }
      if (word === "gaps") return (recording.summary?.gaps ?? 0) > 0;
      if (word === "clipped") return (recording.summary?.clipped ?? 0) > 0;
      return recording.name.toLowerCase().includes(word);
    });

/// What to do with the sensor files of the folder.
function sensorFiles(names: string[]): HTMLElement | false {
  const to = (verb: string, word: string, files: string): HTMLElement => h("a", { class: "btn small", ...link({ v: "analysis", verb: `sensor ${verb}`, file: files }) }, word);
  const row = (name: string): HTMLElement => h("tr", {}, h("th", { scope: "row" }, name), h("td", {}, h("span", { class: "bar" }, to("show", "Show", name), names.length > 1 && to("diff", "Compare…", name), to("export", "Export…", name))));
  return names.length > 0 && h("section", { class: "panel", "aria-label": "Sensor files" }, h("div", { class: "ph" }, h("h2", {}, "Sensor files")), h("div", { class: "pb" }, h("table", {}, h("tbody", {}, ...names.map(row)))));
}

export function recordingsView(main: HTMLElement, folder: string): View {
  let list: RecordingList | undefined;
  let selected = params()["file"] ?? "";
  let ended = false;
  const title = h("span", { class: "soft" });
  const filter = h("input", { type: "search", placeholder: "Filter: name, rate>100, gaps", "aria-label": "Filter: name, rate>100, gaps, clipped", size: 30 });
  filter.value = params()["filter"] ?? "";
  const chooser = h("input", { type: "file", multiple: true, hidden: true });
  const add = h("button", { type: "button", class: "btn", onclick: () => chooser.click() }, "Add file…");
  const said = h("div", { role: "status" });
  const rows = h("div", { class: "list", role: "listbox", tabindex: "0", "aria-label": "Recordings" });
  const side = h("div", {});
  const sensors = h("div", {});
  const titles = h(
    "div",
    { class: "row title", role: "presentation" },
    ...["", "Name", "Signal", "Rate", "Length", "Ch.", "Gaps", "Clipped", "Changed"].map((word, k) =>
      h("span", { class: k >= 3 && k <= 7 ? "num" : k === 8 ? "when" : "" }, word),
    ),
  );
  replace(
    main,
    h("div", { class: "head" }, h("h1", {}, "Recordings"), title, h("div", { class: "acts" }, filter, chooser, add)),
    said,
    h("div", { class: "two" }, h("div", {}, rows, h("div", { class: "drop" }, `Drop files anywhere on this page: they are copied into ${folder}, never over a file.`), sensors), side),
  );

  const shown = (): Recording[] => (list?.recordings ?? []).filter((one) => matches(one, filter.value.trim()));
  const inksOf = (one: Recording): string[] => (one.summary?.thumbnails ?? []).map((curve, k) => channelInk(one.summary?.channels[curve.channel]?.name ?? "", k));

  function rowOf(one: Recording): HTMLElement {
    const summary = one.summary;
    const [kind, word] = lightOf(one);
    const cells: (HTMLElement | false)[] = [];
    const number = (text: string, odd = false): HTMLElement => h("span", { class: "num wide-only" + (odd ? " orange strong" : "") }, text);
    if (summary) {
      const canvas = h("canvas", { "aria-hidden": "true" });
      requestAnimationFrame(() => drawThumbnails(canvas, summary.thumbnails, inksOf(one)));
      cells.push(
        canvas,
        number(summary.rate_hz === null ? "not given" : `${significant(summary.rate_hz, 4)} Hz`, summary.rate_hz === null),
        number(summary.rate_hz === null ? `${count(summary.samples)} rows` : duration(summary.duration_s)),
        number(String(summary.channels.length)),
        number(count(summary.gaps), summary.gaps > 0),
        h("span", { class: "num wide-only" + (summary.clipped > 0 ? " red strong" : "") }, count(summary.clipped)),
      );
    } else {
      cells.push(h("span", { class: one.state === "failed" ? "why" : "why soft" }, one.error ?? (one.state === "running" ? "being inspected…" : "waits to be inspected")));
    }
    const facts = summary ? `${summary.rate_hz === null ? `rate not given · ${count(summary.samples)} rows` : `${significant(summary.rate_hz, 4)} Hz · ${duration(summary.duration_s)}`}${summary.gaps > 0 ? ` · ${count(summary.gaps)} gaps` : ""}${summary.clipped > 0 ? ` · ${count(summary.clipped)} clipped` : ""}` : "";
    const row = h(
      "div",
      { class: "row", role: "option", id: `row-${one.name}`, "aria-selected": String(one.name === selected), onclick: () => choose(one.name, true), ondblclick: () => open(one.name) },
      light(kind, word, true),
      h("span", { class: "file" }, one.name, h("span", { class: "facts" }, facts)),
      ...cells,
      h("span", { class: "when" }, day(one.modified_s)),
    );
    return row;
  }

  function inspector(): void {
    const one = list?.recordings.find((recording) => recording.name === selected);
    if (!one) return replace(side);
    const [kind, word] = lightOf(one);
    const summary = one.summary;
    const inks = inksOf(one);
    replace(
      side,
      h(
        "section",
        { class: "panel", "aria-label": one.name },
        h("div", { class: "ph" }, h("h2", {}, one.name)),
        h(
          "div",
          { class: "pb" },
          h("p", { class: "strong" }, light(kind, word)),
          h(
            "p",
            { class: "bar" },
            summary && h("a", { class: "btn main", ...link({ v: "recording", file: one.name }) }, "Open ", h("kbd", { class: "keys" }, "↵")),
            summary && h("a", { class: "btn", ...link({ v: "analysis", verb: "noise", file: one.name }) }, "Noise ", h("kbd", { class: "keys" }, "n")),
            summary && h("a", { class: "btn", ...link({ v: "analysis", verb: "calibrate", file: one.name }) }, "Calibrate ", h("kbd", { class: "keys" }, "k")),
          ),
          one.error && h("p", { class: "failure" }, one.error),
          summary && h("p", {}, summary.conclusion),
          ...(summary?.thumbnails ?? []).map((curve, k) => {
            const channel = summary?.channels[curve.channel];
            const canvas = h("canvas", { "aria-hidden": "true" });
            requestAnimationFrame(() => drawThumbnails(canvas, [curve], [inks[k] ?? "blue"]));
            const values = [...curve.min, ...curve.max].filter((value): value is number => value !== null);
            return h(
              "div",
              { class: `preview ink-${inks[k] ?? "blue"}` },
              h("div", { class: "of" }, h("span", {}, h("span", { class: "sw" }), ` ${channel?.name ?? ""}`), h("span", { class: "soft" }, `${significant(Math.min(...values), 4)} … ${significant(Math.max(...values), 4)} ${plain(channel?.unit ?? "")}`)),
              canvas,
            );
          }),
          summary &&
            h(
              "dl",
              { class: "kv" },
              ...[
                ["Samples", `${count(summary.samples)} × ${summary.channels.length} channels`],
                ["Format", `${summary.format}, ${bytes(one.bytes)}`],
                ["Channels", summary.channels.map((channel) => `${channel.name}${channel.unit ? " (" + plain(channel.unit) + ")" : ""}`).join(", ")],
              ].flatMap(([name, value]) => [h("dt", {}, name ?? ""), h("dd", {}, value ?? "")]),
            ),
          summary && notesList(summary.notes, 6),
        ),
      ),
    );
  }

  function render(): void {
    const all = shown();
    const size = (list?.recordings ?? []).reduce((sum, one) => sum + one.bytes, 0);
    title.textContent = list ? `${list.recordings.length} in ${folder}, ${bytes(size)}${list.left > 0 ? `; ${list.left} still to be inspected` : ""}` : "reading the folder…";
    replace(rows, titles, ...all.map(rowOf));
    if (list && all.length === 0)
      rows.append(h("p", { class: "empty row", role: "presentation" }, list.recordings.length === 0 ? "There is no recording in this folder." : "No recording matches the filter."));
    replace(sensors, sensorFiles(list?.sensor_files ?? []));
    rows.setAttribute("aria-activedescendant", selected ? `row-${selected}` : "");
    inspector();
  }

  function choose(name: string, byHand: boolean): void {
    selected = name;
    note({ v: "recordings", file: name });
    render();
    if (!byHand) document.getElementById(`row-${name}`)?.scrollIntoView({ block: "nearest" });
    else if (matchMedia("(max-width: 700px)").matches) side.scrollIntoView();
  }
  const open = (name: string): void => go({ v: "recording", file: name });

  function move(by: number): void {
    const all = shown();
    const next = all[Math.min(all.length - 1, Math.max(0, all.findIndex((one) => one.name === selected) + by))];
    if (next) choose(next.name, false);
  }

  async function add_files(files: FileList | File[]): Promise<void> {
    for (const file of files) {
      replace(said, h("p", { class: "soft" }, `${file.name} is being copied…`));
      try {
        selected = await upload(file);
        replace(said);
      } catch (problem) {
        replace(said, h("p", { class: "failure" }, `${file.name}: ${problem instanceof Error ? problem.message : String(problem)}`));
        return;
      }
    }
    list = await listRecordings();
    render();
  }

  async function watch(): Promise<void> {
    while (!ended) {
      try {
        const next = await listRecordings();
        if (ended) return;
        const changed = JSON.stringify(next) !== JSON.stringify(list);
        list = next;
        if (!selected && next.recordings[0]) selected = next.recordings[0].name;
        if (changed) render();
      } catch (problem) {
        if (problem instanceof ApiError) replace(said, h("p", { class: "failure" }, problem.message));
      }
      await pause(list && list.left === 0 ? 5000 : 700);
    }
  }

  filter.addEventListener("input", () => {
    note({ filter: filter.value });
    render();
  });
  chooser.addEventListener("change", () => chooser.files && void add_files(chooser.files));
  rows.addEventListener("keydown", (event) => {
    if (event.key === "ArrowDown" || event.key === "ArrowUp") {
      event.preventDefault();
      move(event.key === "ArrowDown" ? 1 : -1);
    }
  });
  render();
  void watch();
  return {
    dispose: () => {
      ended = true;
    },
    drop: (files) => void add_files(files),
    key: (key) => {
      if (key === "/") filter.focus();
      else if (key === "ArrowDown" || key === "ArrowUp") move(key === "ArrowDown" ? 1 : -1);
      else if (key === "Enter" && selected) open(selected);
      else if (key === "n" && selected) go({ v: "analysis", verb: "noise", file: selected });
      else if (key === "k" && selected) go({ v: "analysis", verb: "calibrate", file: selected });
      else return false;
      return true;
    },
  };
}
