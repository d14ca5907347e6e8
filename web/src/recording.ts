// One recording: strip charts over one time axis, marks, cursors, a stretch, and the noise of what
// is in view.
import { get, pause, type Details, type Figures, type Page, type ViewHead, type ViewState, type Window } from "./api";
import { go, link, note, params } from "./address";
import { colour, h, light, replace, save } from "./dom";
import { count, duration, fixed, plain, significant } from "./format";
import { channelInk } from "./inks";
import { mergedFigure } from "./merge";
import { draw as drawPlot, type Drawn } from "./plot";
import { drawLane, drawOverview, drawStrip, drawTime, plotWidth, timeAt, valueAt, type Scene, type Span } from "./strips";
import type { View } from "./view";

type Mode = "zoom" | "pan" | "stretch" | "cursors";

const standardGravity = 9.80665;

interface Strip {
  channel: number;
  canvas: HTMLCanvasElement;
  value: HTMLElement;
  element: HTMLElement;
}

function spanIn(text: string | undefined): Span | undefined {
  const [from, to] = (text ?? "").split(",").map(Number);
  return from !== undefined && to !== undefined && Number.isFinite(from) && Number.isFinite(to) && from < to ? [from, to] : undefined;
}

// A figure in scale with the span that it is a place in.
function place(value: number, span: Span): string {
  return fixed(value, Math.max(0, Math.min(9, 3 - Math.floor(Math.log10(Math.max(1e-9, span[1] - span[0]))))));
}

export function recordingView(main: HTMLElement, file: string): View {
  const stripHeight = (): number => (innerWidth <= 700 ? 84 : 138);
  let ended = false;
  let head: ViewHead | undefined;
  let details: Details | undefined;
  let whole: Window | undefined;
  let data: Window | undefined;
  let view: Span = [0, 1];
  let all: Span = [0, 1];
  let mode: Mode = "zoom";
  let unit = params()["unit"] ?? "";
  const hidden = new Set((params()["off"] ?? "").split(",").filter((word) => word !== "").map(Number));
  let stretch = spanIn(params()["stretch"]);
  let cursors: (number | undefined)[] = ["a", "b"].map((name) => (params()[name] === undefined ? undefined : Number(params()[name])));
  let pointer: number | undefined;
  let drag: { from: number; to: number; view: Span; pans: boolean } | undefined;
  const past: Span[] = [];
  const strips: Strip[] = [];
  const plots: Drawn[] = [];
  let request: AbortController | undefined;
  let fetching: number | undefined;
  let figuresTimer: number | undefined;

  // ---- the frame
  const facts = h("span", { class: "soft" });
  const verdict = h("span", {});
  const chips = h("span", { class: "bar" });
  const modes = h("span", { class: "seg", role: "group", "aria-label": "What dragging does" });
  const units = h("span", { class: "seg", role: "group", "aria-label": "Unit" });
  const inView = h("span", { class: "soft" });
  const state = h("div", { role: "status" });
  const overview = h("canvas", { "aria-label": "The whole recording, with what is in view framed", role: "img" });
  const lane = h("canvas", { "aria-hidden": "true" });
  overview.style.height = "48px";
  lane.style.height = "26px";
  const stack = h("div", {});
  const time = h("canvas", { "aria-hidden": "true" });
  time.style.height = "34px";
  const counts = h("div", { class: "counts" });
  const table = h("div", { class: "wide", tabindex: "0" });
  const side = h("div", {});
  const analyse = h("a", { class: "btn main" }, "Analyse");
  const strip = (label: HTMLElement | string, canvas: HTMLCanvasElement): HTMLElement => h("div", { class: "strip" }, h("div", { class: "label" }, label), canvas);
  const box = h("section", { class: "strips", "aria-label": "Strip charts", tabindex: "0" }, strip("whole", overview), strip("marks", lane), stack, strip("", time), counts);
  replace(
    main,
    h("div", { class: "head" }, h("a", { ...link({ v: "recordings", file }) }, "‹ Recordings"), h("h1", {}, file), verdict, facts, h("div", { class: "acts" }, analyse, button("PNG", () => savePng()), button("CSV", () => saveCsv()))),
    h("div", { class: "bar" }, chips),
    h("div", { class: "bar" }, modes, units, h("span", { class: "bar end" }, inView, button("+", () => zoomBy(0.5), "Zoom in"), button("−", () => zoomBy(2), "Zoom out"), button("Fit", fit))),
    state,
    h("div", { class: "rec" }, h("div", {}, box, table), side),
  );

  function button(text: string, act: () => void, name?: string): HTMLButtonElement {
    return h("button", { type: "button", class: "btn", onclick: act, "aria-label": name }, text);
  }

  function toggles(at: HTMLElement, words: [string, string][], is: () => string, set: (word: string) => void): void {
    replace(
      at,
      ...words.map(([word, text]) =>
        h("button", { type: "button", "aria-pressed": String(is() === word), onclick: () => { set(word); toggles(at, words, is, set); } }, text),
      ),
    );
  }

  // ---- units
  const isAcceleration = (channel: number): boolean => head?.channels[channel]?.quantity === "acceleration";
  function factor(channel: number): number {
    const si = head?.channels[channel]?.to_si ?? 1;
    if (!isAcceleration(channel) || unit === "") return 1;
    return unit === "m/s²" ? si : unit === "g" ? si / standardGravity : (1000 * si) / standardGravity;
  }
  const unitOf = (channel: number): string => (isAcceleration(channel) && unit !== "" ? unit : plain(head?.channels[channel]?.unit ?? ""));

  function noteState(): void {
    note({
      from: String(view[0]), to: String(view[1]), unit,
      off: [...hidden].join(","),
      stretch: stretch ? stretch.join(",") : "",
      a: cursors[0] === undefined ? "" : String(cursors[0]),
      b: cursors[1] === undefined ? "" : String(cursors[1]),
    });
  }

  function clamp(span: Span): Span {
    const length = Math.min(span[1] - span[0], all[1] - all[0]);
    const shortest = 4 / (head?.rate_hz && head.rate_hz > 0 ? head.rate_hz : 1);
    const size = Math.max(length, Math.min(shortest, all[1] - all[0]));
    const from = Math.min(Math.max(all[0], span[0]), all[1] - size);
    return [from, from + size];
  }
  function show(span: Span, keep = true): void {
    if (keep) past.push(view);
    view = clamp(span);
    noteState();
    redraw();
    window.clearTimeout(fetching);
    fetching = window.setTimeout(() => void load(), 60);
    window.clearTimeout(figuresTimer);
    figuresTimer = window.setTimeout(() => void noise(), 700);
  }
  function zoomBy(by: number, at = (view[0] + view[1]) / 2): void {
    show([at - (at - view[0]) * by, at + (view[1] - at) * by]);
  }
  const panBy = (part: number): void => show([view[0] + part * (view[1] - view[0]), view[1] + part * (view[1] - view[0])]);
  function fit(): void {
    show(all);
  }

  // ---- data
  async function window_of(span: Span, pixels: number, signal?: AbortSignal): Promise<Window> {
    return get<Window>("/api/view/window", { file, from: span[0], to: span[1], pixels }, signal);
  }
  async function load(): Promise<void> {
    request?.abort();
    request = new AbortController();
    try {
      data = await window_of(view, Math.min(4000, plotWidth(time)), request.signal);
      if (!ended) redraw();
    } catch (problem) {
      if (!(problem instanceof DOMException)) replace(state, h("p", { class: "failure" }, String(problem instanceof Error ? problem.message : problem)));
    }
  }

  // ---- drawing
  function scene(): Scene | undefined {
    if (!head) return undefined;
    const dragged = drag && !drag.pans ? ([Math.min(drag.from, drag.to), Math.max(drag.from, drag.to)] as Span) : undefined;
    return { head, details, whole, data, all, view, stretch: mode === "stretch" && dragged ? dragged : stretch, zoom: mode === "zoom" ? dragged : undefined, cursors, pointer: drag ? undefined : pointer };
  }
  let frame = 0;
  function redraw(): void {
    cancelAnimationFrame(frame);
    frame = requestAnimationFrame(() => {
      const now = scene();
      if (!now) return;
      drawOverview(now, overview, strips.map((one) => one.channel));
      drawLane(now, lane);
      for (const one of strips) {
        drawStrip(now, one.canvas, one.channel, factor(one.channel));
        one.value.textContent = pointer === undefined ? "" : significant(valueAt(data, pointer, one.channel) * factor(one.channel), 5);
      }
      drawTime(now, time);
      inView.textContent = `In view ${place(view[0], view)} – ${place(view[1], view)} s`;
      const span = stretch ?? (view[1] - view[0] < 0.999 * (all[1] - all[0]) ? view : undefined);
      replace(analyse, stretch ? "Analyse stretch" : span ? "Analyse what is in view" : "Analyse", " ", h("kbd", { class: "keys" }, "n"));
      const to = analysisAddress();
      const made = link(to);
      analyse.href = made.href;
      analyse.onclick = made.onclick;
    });
  }
  function analysisAddress(): { [name: string]: string } {
    const span = stretch ?? (view[1] - view[0] < 0.999 * (all[1] - all[0]) ? view : undefined);
    return { v: "analysis", verb: "noise", file, ...(span ? { "o.from": String(Number(span[0].toFixed(6))), "o.to": String(Number(span[1].toFixed(6))) } : {}) };
  }

  // ---- chips, strips, counts
  function build(): void {
    if (!head) return;
    strips.length = 0;
    stack.replaceChildren();
    chips.replaceChildren();
    const most = 12;
    head.channels.forEach((channel, k) => {
      const ink = channelInk(channel.name, k);
      const chip = h("button", { type: "button", class: `chip ink-${ink}`, "aria-pressed": String(!hidden.has(k)), onclick: () => { hidden.has(k) ? hidden.delete(k) : hidden.add(k); noteState(); build(); } }, h("span", { class: "sw" }), channel.name, k < 9 && h("kbd", { class: "keys" }, String(k + 1)));
      chips.append(chip);
      if (hidden.has(k) || strips.length >= most) return;
      const canvas = h("canvas", { role: "img", "aria-label": `${channel.name} against time` });
      canvas.style.height = `${stripHeight()}px`;
      const value = h("span", {});
      const element = h("div", { class: `strip ink-${ink}` }, h("div", { class: "label" }, h("b", {}, h("span", { class: "sw" }), ` ${channel.name}`), h("span", {}, unitOf(k)), value), canvas);
      listen(canvas);
      stack.append(element);
      strips.push({ channel: k, canvas, value, element });
    });
    buildCounts();
  }
  function buildCounts(): void {
    if (!head) return;
    const clipped = (details?.json?.channels ?? []).filter((channel) => channel.clipped > 0);
    const gaps = details?.json?.timing.gaps ?? [];
    replace(
      counts,
      h("span", {}, h("b", {}, String(head.rests?.length ?? 0)), ` rests${head.rests?.length || !head.why_no_rests ? "" : `: ${head.why_no_rests}`}`),
      h("span", {}, h("b", {}, String(head.knocks_s?.length ?? 0)), " outliers within them"),
      h("span", {}, h("b", { class: clipped.length > 0 ? "red" : "" }, count(clipped.reduce((sum, channel) => sum + channel.clipped, 0))), ` readings clipped${clipped.length > 0 ? `: ${clipped.map((channel) => `${channel.name} ${channel.clipped}`).join(", ")}` : ""}`),
      h("span", {}, h("b", {}, count(gaps.length)), ` gaps${gaps[0] ? `, the first ${significant(gaps[0].duration_s, 3)} s at ${significant(gaps[0].start_s, 6)} s` : ""}`),
      h("span", {}, "previous ", h("kbd", { class: "keys" }, "["), " next ", h("kbd", { class: "keys" }, "]")),
    );
    redraw();
  }

  // ---- pointer
  function listen(canvas: HTMLCanvasElement): void {
    const touches = new Map<number, number>();
    let press: number | undefined;
    const at = (event: PointerEvent | MouseEvent): number => timeAt(event.offsetX, view, plotWidth(canvas));
    canvas.addEventListener("pointerdown", (event) => {
      canvas.setPointerCapture(event.pointerId);
      touches.set(event.pointerId, event.offsetX);
      const pans = event.shiftKey || mode === "pan" || event.pointerType === "touch";
      drag = { from: at(event), to: at(event), view, pans };
      if (event.pointerType === "touch") press = window.setTimeout(() => setCursor(at(event)), 600);
      if (mode === "cursors" && !pans) setCursor(at(event));
    });
    canvas.addEventListener("pointermove", (event) => {
      pointer = at(event);
      const before = touches.get(event.pointerId);
      if (drag && before !== undefined) {
        const width = plotWidth(canvas);
        if (Math.abs(event.offsetX - before) > 3) window.clearTimeout(press);
        if (touches.size === 2) {
          const other = [...touches.entries()].find(([id]) => id !== event.pointerId)?.[1] ?? 0;
          const by = Math.abs(before - other) / Math.max(10, Math.abs(event.offsetX - other));
          touches.set(event.pointerId, event.offsetX);
          const middle = timeAt((event.offsetX + other) / 2, view, width);
          view = clamp([middle - (middle - view[0]) * by, middle + (view[1] - middle) * by]);
          drag = { ...drag, view };
        } else if (drag.pans) {
          const moved = ((event.offsetX - before) / width) * (view[1] - view[0]);
          touches.set(event.pointerId, event.offsetX);
          view = clamp([view[0] - moved, view[1] - moved]);
        } else {
          drag.to = at(event);
          if (mode === "cursors") setCursor(at(event), true);
        }
      }
      redraw();
    });
    const end = (event: PointerEvent): void => {
      window.clearTimeout(press);
      touches.delete(event.pointerId);
      if (!drag || touches.size > 0) return;
      const done = drag;
      drag = undefined;
      const span: Span = [Math.min(done.from, done.to), Math.max(done.from, done.to)];
      const isDrag = ((span[1] - span[0]) / (view[1] - view[0])) * plotWidth(canvas) > 4;
      if (done.pans) {
        past.push(done.view);
        show(view, false);
      } else if (mode === "zoom" && isDrag) show(span);
      else if (mode === "stretch") setStretch(isDrag ? span : restAt(span[0]));
      redraw();
    };
    canvas.addEventListener("pointerup", end);
    canvas.addEventListener("pointercancel", end);
    canvas.addEventListener("pointerleave", () => {
      pointer = undefined;
      redraw();
    });
    canvas.addEventListener("dblclick", fit);
    canvas.addEventListener("wheel", (event) => {
      event.preventDefault();
      zoomBy(Math.pow(1.0015, event.deltaY), at(event));
    }, { passive: false });
  }
  const moveOverview = (event: PointerEvent): void => {
    if (event.buttons === 0 && event.type !== "pointerdown") return;
    const middle = timeAt(event.offsetX, all, plotWidth(overview));
    const half = (view[1] - view[0]) / 2;
    show([middle - half, middle + half], event.type === "pointerdown");
  };
  overview.addEventListener("pointerdown", moveOverview);
  overview.addEventListener("pointermove", moveOverview);

  // A click within a rest chooses it.
  const restAt = (t: number): Span | undefined => head?.rests?.find((rest) => rest[0] <= t && t <= rest[1]);
  function setStretch(span: Span | undefined): void {
    stretch = span ? [Math.max(all[0], span[0]), Math.min(all[1], span[1])] : undefined;
    noteState();
    redraw();
    void noise();
  }
  let nextCursor = 0;
  function setCursor(t: number, keep = false): void {
    if (!keep) nextCursor = 1 - nextCursor;
    cursors[1 - nextCursor] = Math.min(all[1], Math.max(all[0], t));
    noteState();
    redraw();
    window.clearTimeout(figuresTimer);
    figuresTimer = window.setTimeout(() => void figures(), 150);
  }

  // ---- the table between the cursors
  async function readingAt(t: number): Promise<number[]> {
    const step = 1.5 / (head?.rate_hz && head.rate_hz > 0 ? head.rate_hz : 1);
    const near = await window_of([t - step, t + step], 1000);
    let best = 0;
    near.t.forEach((one, k) => Math.abs(one - t) < Math.abs((near.t[best] ?? Infinity) - t) && (best = k));
    return near.min.map((values) => values[best] ?? NaN);
  }
  async function figures(): Promise<void> {
    const [a, b] = cursors;
    if (!head || a === undefined || b === undefined || a === b) {
      replace(table, a !== undefined && h("p", { class: "soft" }, `Cursor A at ${place(a, view)} s: set the other one for Δt, Δy, mean and rms between them.`));
      return;
    }
    const [from, to] = [Math.min(a, b), Math.max(a, b)];
    const [between, atA, atB] = await Promise.all([get<Figures>("/api/view/figures", { file, from, to }), readingAt(a), readingAt(b)]);
    if (ended) return;
    const cell = (value: number): HTMLElement => h("td", { class: "num" }, significant(value, 5));
    const headings = ["Channel", `A ${place(a, view)} s`, `B ${place(b, view)} s`, "Δy = B − A", "mean A…B", "rms A…B", "std A…B", "min", "max"];
    replace(
      table,
      h(
        "table",
        {},
        h("caption", {}, `Δt ${significant(b - a, 6)} s, 1/Δt ${significant(1 / (b - a), 5)} Hz`),
        h("thead", {}, h("tr", {}, ...headings.map((word, k) => h("th", { scope: "col", class: k > 0 ? "num" : "" }, word)))),
        h(
          "tbody",
          {},
          ...strips.map(({ channel }) => {
            const scale = factor(channel);
            const one = between.channels[channel];
            return h("tr", {}, h("th", { scope: "row" }, `${head?.channels[channel]?.name ?? ""} (${unitOf(channel) || "no unit"})`), cell((atA[channel] ?? NaN) * scale), cell((atB[channel] ?? NaN) * scale), cell(((atB[channel] ?? NaN) - (atA[channel] ?? NaN)) * scale), cell((one?.mean ?? NaN) * scale), cell((one?.rms ?? NaN) * scale), cell((one?.std ?? NaN) * scale), cell((one?.min ?? NaN) * scale), cell((one?.max ?? NaN) * scale));
          }),
        ),
      ),
    );
  }

  // ---- spectrum and Allan deviation of the stretch, or of what is in view
  let noiseRun = 0;
  async function noise(): Promise<void> {
    const run = ++noiseRun;
    const span = stretch ?? view;
    const words = `${place(span[0], span)} – ${place(span[1], span)} s`;
    const body = h("div", { class: "pb side" }, h("p", { class: "soft" }, "being computed…"));
    const panel = h("section", { class: "panel", "aria-label": "Spectrum and Allan deviation" }, h("div", { class: "ph" }, h("h2", {}, stretch ? "Stretch" : "In view"), h("span", { class: "soft" }, words)), body);
    const most = 3;
    const shown = strips.map((one) => one.channel);
    const channels = [...shown.filter(isAcceleration), ...shown.filter((channel) => !isAcceleration(channel))].slice(0, most);
    const results = await Promise.all(
      channels.map((channel) => get<Page>("/api/view/noise", { file, from: span[0], to: span[1], channel }).catch((problem: unknown) => (problem instanceof Error ? problem.message : String(problem)))),
    );
    if (ended || run !== noiseRun) return;
    while (plots.length > 0) plots.pop()?.dispose();
    replace(side, panel);
    const good = results.map((page, k) => ({ page, channel: channels[k] as number })).filter((one): one is { page: Page; channel: number } => typeof one.page !== "string");
    const reasons = [...new Set(results.filter((page): page is string => typeof page === "string"))];
    const named = good.map(({ page, channel }) => ({ page, name: head?.channels[channel]?.name ?? "", ink: channelInk(head?.channels[channel]?.name ?? "", channel) }));
    const parts: (HTMLElement | false)[] = [];
    for (const wanted of [/spectr/i, /deviation/i]) {
      const figure = mergedFigure(named, wanted);
      if (!figure) continue;
      const drawn = drawPlot({ ...figure, height: 180 }, { height: 190, below: true });
      plots.push(drawn);
      parts.push(h("h3", {}, figure.title), drawn.element);
    }
    const rows = named.flatMap(({ page, name }) => page.key_figures.map((figure) => h("tr", {}, h("th", { scope: "row" }, `${name}: ${figure.label}`), h("td", { class: "num" }, figure.value))));
    replace(
      body,
      ...reasons.map((reason) => h("p", { class: "soft" }, reason)),
      ...parts,
      rows.length > 0 && h("table", {}, h("tbody", {}, ...rows)),
      good.length > 0 && h("p", {}, h("a", { ...link(analysisAddress()) }, "Open as an analysis")),
    );
  }

  // ---- export of what is seen
  function savePng(): void {
    const canvases = [lane, ...strips.map((one) => one.canvas), time];
    const width = Math.max(...canvases.map((canvas) => canvas.width));
    const copy = h("canvas", { width, height: canvases.reduce((sum, canvas) => sum + canvas.height, 0) });
    const ctx = copy.getContext("2d");
    if (!ctx) return;
    ctx.fillStyle = colour("paper");
    ctx.fillRect(0, 0, copy.width, copy.height);
    let y = 0;
    for (const canvas of canvases) {
      ctx.drawImage(canvas, 0, y);
      y += canvas.height;
    }
    copy.toBlob((made) => made && save(`${file.split("/").at(-1) ?? "recording"}.png`, made));
  }
  function saveCsv(): void {
    if (!data) return;
    const names = strips.flatMap(({ channel }) => { const name = head?.channels[channel]?.name ?? ""; return data?.samples ? [name] : [`${name} min`, `${name} max`]; });
    const rows = data.t.map((t, k) => [t, ...strips.flatMap(({ channel }) => (data?.samples ? [data.min[channel]?.[k]] : [data?.min[channel]?.[k], data?.max[channel]?.[k]]))].map((value) => value ?? "").join(","));
    save(`${file.split("/").at(-1) ?? "recording"}-view.csv`, new Blob([`time_s,${names.join(",")}\n${rows.join("\n")}\n`], { type: "text/csv" }));
  }

  // ---- opening
  async function open(): Promise<void> {
    let drawn = false;
    while (!ended) {
      const now = await get<ViewState>("/api/view", { file });
      if (ended) return;
      if (now.error) return replace(state, h("p", { class: "failure" }, now.error));
      if (now.head && (!drawn || now.state === "done")) {
        head = now.head;
        all = [0, head.end_s > 0 ? head.end_s : 1];
        const asked = spanIn(`${params()["from"]},${params()["to"]}`);
        view = clamp(asked ?? all);
        drawn = true;
        // If there are many channels, the accelerations are shown; the others are one click away.
        if (params()["off"] === undefined && head.channels.length > 6 && head.channels.some((_, k) => isAcceleration(k)))
          head.channels.forEach((_, k) => !isAcceleration(k) && hidden.add(k));
        const accelerations = head.channels.some((_, k) => isAcceleration(k));
        if (accelerations) toggles(units, [["", plain(head.channels.find((one) => one.quantity === "acceleration")?.unit ?? "")], ...(["m/s²", "g", "mg"] as const).filter((one) => one !== plain(head?.channels.find((channel) => channel.quantity === "acceleration")?.unit ?? "")).map((one): [string, string] => [one, one])], () => unit, (word) => { unit = word; noteState(); build(); void figures(); });
        toggles(modes, [["zoom", "Zoom"], ["pan", "Pan"], ["stretch", "Stretch"], ["cursors", "Cursors"]], () => mode, (word) => { mode = word as Mode; });
        facts.textContent = `${head.rate_hz ? `${significant(head.rate_hz, 5)} Hz · ` : ""}${duration(head.end_s)} · ${head.channels.length} channels`;
        build();
        whole = await window_of(all, Math.min(1000, plotWidth(overview)));
        await load();
      }
      if (now.state === "done") break;
      replace(state, h("p", { class: "bar" }, h("span", {}, `being read: ${now.stage || "waiting"}, ${Math.round(100 * now.fraction)} %`), progress(now.fraction)));
      await pause(200);
    }
    replace(state);
    void noise();
    void figures();
  }
  async function inspect(): Promise<void> {
    while (!ended) {
      try {
        details = await get<Details>("/api/recording", { file });
      } catch {
        // Not in the list yet: this view may be the first that is asked for.
        await get("/api/recordings");
      }
      if (details?.error) return;
      if (details?.json) {
        const notes = details.summary?.notes ?? [];
        const faults = notes.filter((one) => one.severity === "bad").length;
        const warnings = notes.filter((one) => one.severity === "warning").length;
        replace(verdict, faults > 0 ? light("bad", `${faults} ${faults === 1 ? "fault" : "faults"} in the data`) : warnings > 0 ? light("warning", `${warnings} ${warnings === 1 ? "thing" : "things"} to know`) : light("good", "nothing wrong with it"));
        // The strips stay: somebody may be dragging on one.
        return buildCounts();
      }
      await pause(400);
    }
  }
  const watch = new ResizeObserver(() => {
    redraw();
    window.clearTimeout(fetching);
    fetching = window.setTimeout(() => head && void load(), 100);
  });
  watch.observe(box);
  open().catch((problem: unknown) => replace(state, h("p", { class: "failure" }, problem instanceof Error ? problem.message : String(problem))));
  void inspect();

  function jump(forwards: boolean): void {
    const marks = [...(head?.rests ?? []).map((rest) => rest[0]), ...(head?.knocks_s ?? []), ...(details?.json?.timing.gaps ?? []).map((gap) => gap.start_s)].sort((a, b) => a - b);
    const middle = (view[0] + view[1]) / 2;
    const slack = 1e-6 * (view[1] - view[0]);
    const to = forwards ? marks.find((mark) => mark > middle + slack) : marks.filter((mark) => mark < middle - slack).at(-1);
    if (to === undefined) return;
    const half = (view[1] - view[0]) / 2;
    show([to - half, to + half]);
  }

  return {
    dispose: () => {
      ended = true;
      watch.disconnect();
      window.clearTimeout(fetching);
      window.clearTimeout(figuresTimer);
      for (const one of plots) one.dispose();
    },
    key: (key) => {
      const digit = Number(key);
      if (key === "ArrowLeft") panBy(-0.25);
      else if (key === "ArrowRight") panBy(0.25);
      else if (key === "+" || key === "=") zoomBy(0.5);
      else if (key === "-") zoomBy(2);
      else if (key === "f") fit();
      else if (key === "Backspace") {
        const before = past.pop();
        if (before) show(before, false);
      } else if (key === "a" || key === "b") {
        cursors[key === "a" ? 0 : 1] = pointer ?? (view[0] + view[1]) / 2;
        noteState();
        redraw();
        void figures();
      } else if (key === "s") setStretch(stretch ? undefined : [...view]);
      else if (key === "[" || key === "]") jump(key === "]");
      else if (key === "u") units.querySelector<HTMLButtonElement>("button[aria-pressed=true] + button, button:first-child")?.click();
      else if (key === "n") go(analysisAddress());
      else if (key === "Escape") go({ v: "recordings", file });
      else if (digit >= 1 && digit <= 9) chips.querySelectorAll("button")[digit - 1]?.click();
      else return false;
      return true;
    },
  };
}

export function progress(fraction: number): HTMLElement {
  const bar = h("i", {});
  bar.style.width = `${Math.round(100 * fraction)}%`;
  return h("span", { class: "progress", role: "progressbar", "aria-valuemin": "0", "aria-valuemax": "100", "aria-valuenow": Math.round(100 * fraction), "aria-label": "Progress" }, bar);
}
