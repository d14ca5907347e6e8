// One recording: strip charts over one time axis, marks, cursors, a stretch, and the noise of what
// is in view.
import { get, pause, type Details, type Figures, type Page, type ViewHead, type ViewState, type Window } from "./api";
import { go, link, note, params } from "./address";
import { colour, h, light, replace, save } from "./dom";
import { count, duration, fixed, plain, significant, ticks } from "./format";
import { channelInk } from "./inks";
import { mergedFigure } from "./merge";
import { draw as drawPlot, type Drawn } from "./plot";
import type { View } from "./view";

type Span = [number, number];
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

function context(canvas: HTMLCanvasElement): { ctx: CanvasRenderingContext2D; width: number; height: number } | undefined {
  const { clientWidth: width, clientHeight: height } = canvas;
  const ctx = canvas.getContext("2d");
  if (!ctx || width === 0) return undefined;
  const ratio = devicePixelRatio;
  if (canvas.width !== Math.round(width * ratio) || canvas.height !== Math.round(height * ratio)) {
    canvas.width = Math.round(width * ratio);
    canvas.height = Math.round(height * ratio);
  }
  ctx.setTransform(ratio, 0, 0, ratio, 0, 0);
  ctx.clearRect(0, 0, width, height);
  return { ctx, width, height };
}

export function recordingView(main: HTMLElement, file: string): View {
  const left = 44; // of the value axis, within each canvas
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

  // ---- places
  const plotWidth = (canvas: HTMLCanvasElement): number => Math.max(1, canvas.clientWidth - left - 6);
  const px = (t: number, span: Span, width: number): number => left + ((t - span[0]) / (span[1] - span[0])) * width;
  const timeAt = (x: number, span: Span, width: number): number => span[0] + ((x - left) / width) * (span[1] - span[0]);

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
  function gapsIn(span: Span): Span[] {
    return (details?.json?.timing.gaps ?? []).map((gap): Span => [gap.start_s, gap.start_s + gap.duration_s]).filter((gap) => gap[1] > span[0] && gap[0] < span[1]);
  }
  function hatch(ctx: CanvasRenderingContext2D, x0: number, x1: number, height: number): void {
    ctx.save();
    ctx.beginPath();
    ctx.rect(x0, 0, Math.max(1, x1 - x0), height);
    ctx.clip();
    ctx.strokeStyle = colour("mark");
    ctx.lineWidth = 0.7;
    ctx.beginPath();
    for (let x = x0 - height; x < x1; x += 5) {
      ctx.moveTo(x, height);
      ctx.lineTo(x + height, 0);
    }
    ctx.stroke();
    ctx.restore();
  }
  // A curve of samples, or of columns from the smallest to the largest value, broken at gaps.
  function curve(ctx: CanvasRenderingContext2D, from: Window, channel: number, x: (t: number) => number, y: (v: number) => number): void {
    const min = from.min[channel] ?? [];
    const max = from.samples ? min : (from.max[channel] ?? min);
    const gaps = gapsIn([from.t[0] ?? 0, from.t.at(-1) ?? 0]);
    let gap = 0;
    let before: number | undefined;
    ctx.beginPath();
    from.t.forEach((t, k) => {
      const low = min[k];
      const high = max[k];
      let broken = false;
      while (gap < gaps.length && (gaps[gap] as Span)[1] <= t + 1e-12) {
        broken = true;
        ++gap;
      }
      if (low === null || high === null || low === undefined || high === undefined) {
        before = undefined;
        return;
      }
      const at = x(t);
      if (before === undefined || broken) ctx.moveTo(at, y(low));
      else ctx.lineTo(at, y(Math.abs(low - before) < Math.abs(high - before) ? low : high));
      if (high !== low) {
        ctx.moveTo(at, y(low));
        ctx.lineTo(at, y(high));
      }
      if (from.samples && from.t.length < 80) ctx.rect(at - 1, y(low) - 1, 2, 2);
      before = high;
    });
    ctx.stroke();
  }
  function ends(from: Window | undefined, channel: number): Span {
    let low = Infinity;
    let high = -Infinity;
    from?.t.forEach((t, k) => {
      if (t < view[0] - (view[1] - view[0]) * 0.01 || t > view[1]) return;
      for (const value of [from.min[channel]?.[k], from.samples ? undefined : from.max[channel]?.[k]])
        if (value !== null && value !== undefined) {
          low = Math.min(low, value);
          high = Math.max(high, value);
        }
    });
    if (!(low <= high)) return [-1, 1];
    const room = (high - low) * 0.06 || Math.abs(high) * 1e-3 || 1e-6;
    return [low - room, high + room];
  }
  function under(ctx: CanvasRenderingContext2D, width: number, height: number): void {
    ctx.fillStyle = colour("rest");
    for (const rest of head?.rests ?? []) {
      if (rest[1] < view[0] || rest[0] > view[1]) continue;
      ctx.fillRect(px(rest[0], view, width), 0, px(rest[1], view, width) - px(rest[0], view, width), height);
    }
    const chosen = mode === "stretch" && drag && !drag.pans ? ([Math.min(drag.from, drag.to), Math.max(drag.from, drag.to)] as Span) : stretch;
    if (chosen) {
      ctx.fillStyle = colour("stretch");
      const x0 = px(chosen[0], view, width);
      const x1 = px(chosen[1], view, width);
      ctx.fillRect(x0, 0, x1 - x0, height);
      ctx.fillStyle = colour("blue");
      ctx.fillRect(x0, 0, 1, height);
      ctx.fillRect(x1, 0, 1, height);
    }
    for (const gap of gapsIn(view)) hatch(ctx, px(gap[0], view, width), px(gap[1], view, width), height);
    if (mode === "zoom" && drag && !drag.pans) {
      ctx.fillStyle = colour("stretch");
      const x0 = px(Math.min(drag.from, drag.to), view, width);
      ctx.fillRect(x0, 0, px(Math.max(drag.from, drag.to), view, width) - x0, height);
    }
  }
  function over(ctx: CanvasRenderingContext2D, width: number, height: number): void {
    ctx.fillStyle = colour("ink");
    for (const cursor of cursors) if (cursor !== undefined && cursor >= view[0] && cursor <= view[1]) ctx.fillRect(px(cursor, view, width), 0, 1, height);
    if (pointer !== undefined && !drag) {
      ctx.fillStyle = colour("mark");
      ctx.fillRect(px(pointer, view, width), 0, 1, height);
    }
  }
  function drawStrip(one: Strip): void {
    const got = context(one.canvas);
    if (!got) return;
    const { ctx, height } = got;
    const width = plotWidth(one.canvas);
    const scale = factor(one.channel);
    const [low, high] = ends(data, one.channel);
    const y = (value: number): number => height - 4 - ((value - low) / (high - low)) * (height - 8);
    under(ctx, width, height);
    ctx.font = `11px ${colour("sans")}`;
    ctx.textAlign = "right";
    const grid = ticks(Math.min(low * scale, high * scale), Math.max(low * scale, high * scale), height / 40);
    for (const value of grid.values) {
      const at = y(value / scale);
      ctx.fillStyle = colour("grid");
      ctx.fillRect(left, at, width, 1);
      ctx.fillStyle = colour("soft");
      ctx.fillText(fixed(value, grid.decimals), left - 6, at + 4);
    }
    ctx.save();
    ctx.beginPath();
    ctx.rect(left, 0, width, height);
    ctx.clip();
    ctx.strokeStyle = colour(channelInk(head?.channels[one.channel]?.name ?? "", one.channel));
    ctx.lineWidth = 1;
    if (data) curve(ctx, data, one.channel, (t) => px(t, view, width), y);
    const audit = details?.json?.channels.find((channel) => channel.name === head?.channels[one.channel]?.name);
    if (audit && audit.clipped > 0)
      for (const [limit, values, hit] of [[audit.limit_low, data?.min, (v: number, l: number) => v <= l], [audit.limit_high, data?.samples ? data.min : data?.max, (v: number, l: number) => v >= l]] as [number | null, (number | null)[][] | undefined, (v: number, l: number) => boolean][]) {
        if (limit === null) continue;
        ctx.setLineDash([4, 3]);
        ctx.strokeStyle = colour("red");
        ctx.beginPath();
        ctx.moveTo(left, y(limit));
        ctx.lineTo(left + width, y(limit));
        ctx.stroke();
        ctx.setLineDash([]);
        ctx.fillStyle = colour("red");
        values?.[one.channel]?.forEach((value, k) => value !== null && hit(value, limit) && ctx.fillRect(px(data?.t[k] ?? 0, view, width) - 2, y(limit) - 2, 4, 4));
      }
    ctx.restore();
    over(ctx, width, height);
    one.value.textContent = pointer === undefined ? "" : significant(valueAt(pointer, one.channel) * scale, 5);
  }
  function valueAt(t: number, channel: number): number {
    if (!data || data.t.length === 0) return NaN;
    const times = data.t;
    let best = 0;
    times.forEach((one, k) => {
      if (Math.abs(one - t) < Math.abs((times[best] ?? Infinity) - t)) best = k;
    });
    const low = data.min[channel]?.[best];
    const high = data.samples ? low : data.max[channel]?.[best];
    return low === null || high === null || low === undefined || high === undefined ? NaN : (low + high) / 2;
  }
  function drawOverview(): void {
    const got = context(overview);
    if (!got) return;
    const { ctx, height } = got;
    const width = plotWidth(overview);
    ctx.globalAlpha = 0.5;
    if (whole)
      for (const one of strips) {
        let low = Infinity;
        let high = -Infinity;
        whole.min[one.channel]?.forEach((value) => value !== null && (low = Math.min(low, value)));
        (whole.samples ? whole.min : whole.max)[one.channel]?.forEach((value) => value !== null && (high = Math.max(high, value)));
        ctx.strokeStyle = colour(channelInk(head?.channels[one.channel]?.name ?? "", one.channel));
        curve(ctx, whole, one.channel, (t) => px(t, all, width), (value) => height - 5 - ((value - low) / (high - low || 1)) * (height - 10));
      }
    ctx.globalAlpha = 1;
    for (const gap of gapsIn(all)) hatch(ctx, px(gap[0], all, width), px(gap[1], all, width), height);
    const x0 = px(view[0], all, width);
    const x1 = Math.max(x0 + 3, px(view[1], all, width));
    ctx.strokeStyle = colour("ink");
    ctx.lineWidth = 1;
    ctx.strokeRect(x0 + 0.5, 0.5, x1 - x0 - 1, height - 1);
    ctx.fillStyle = colour("ink");
    ctx.fillRect(x0 - 1, height / 2 - 7, 3, 14);
    ctx.fillRect(x1 - 2, height / 2 - 7, 3, 14);
  }
  function drawLane(): void {
    const got = context(lane);
    if (!got) return;
    const { ctx, height } = got;
    const width = plotWidth(lane);
    ctx.font = `11px ${colour("sans")}`;
    ctx.textAlign = "center";
    under(ctx, width, height);
    (head?.rests ?? []).forEach((rest, k) => {
      if (rest[1] < view[0] || rest[0] > view[1]) return;
      const x0 = Math.max(left, px(rest[0], view, width));
      const x1 = Math.min(left + width, px(rest[1], view, width));
      ctx.fillStyle = colour("green");
      ctx.fillRect(x0, height - 3, x1 - x0, 2);
      const word = `rest ${k + 1}`;
      if (ctx.measureText(word).width < x1 - x0 - 4) {
        ctx.fillStyle = colour("ink");
        ctx.fillText(word, (x0 + x1) / 2, height - 9);
      }
    });
    ctx.fillStyle = colour("purple");
    for (const knock of head?.knocks_s ?? []) {
      if (knock < view[0] || knock > view[1]) continue;
      const x = px(knock, view, width);
      ctx.beginPath();
      ctx.moveTo(x - 4, 2);
      ctx.lineTo(x + 4, 2);
      ctx.lineTo(x, 9);
      ctx.fill();
    }
    cursors.forEach((cursor, k) => {
      if (cursor === undefined || cursor < view[0] || cursor > view[1]) return;
      const x = px(cursor, view, width);
      ctx.fillStyle = colour("ink");
      ctx.fillRect(x - 7, 0, 15, 14);
      ctx.fillStyle = colour("paper");
      ctx.fillText("AB".charAt(k), x + 0.5, 11);
    });
  }
  function drawTime(): void {
    const got = context(time);
    if (!got) return;
    const width = plotWidth(time);
    const grid = ticks(view[0], view[1], width / 90);
    got.ctx.font = `11px ${colour("sans")}`;
    got.ctx.fillStyle = colour("soft");
    got.ctx.textAlign = "center";
    for (const value of grid.values) got.ctx.fillText(fixed(value, grid.decimals), px(value, view, width), 12);
    got.ctx.textAlign = "right";
    got.ctx.fillText(head?.rate_hz === 0 ? "Sample" : "Time since the first sample (s)", left + width, 30);
  }
  let frame = 0;
  function redraw(): void {
    cancelAnimationFrame(frame);
    frame = requestAnimationFrame(() => {
      if (!head) return;
      drawOverview();
      drawLane();
      strips.forEach(drawStrip);
      drawTime();
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
    const clipped = (details?.json?.channels ?? []).filter((channel) => channel.clipped > 0);
    const gaps = details?.json?.timing.gaps ?? [];
    replace(
      counts,
      h("span", {}, h("b", {}, String(head.rests?.length ?? 0)), ` rests${head.rests?.length || !head.why_no_rests ? "" : `: ${head.why_no_rests}`}`),
      h("span", {}, h("b", {}, String(head.knocks_s?.length ?? 0)), " knocks within them"),
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
        // Of many channels the accelerations are shown; the others are one click away.
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
        return build();
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
