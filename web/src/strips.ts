// What the canvases of one recording show. Everything is drawn from a scene; nothing is kept here.
import type { Details, ViewHead, Window } from "./api";
import { colour } from "./dom";
import { fixed, ticks } from "./format";
import { channelInk } from "./inks";

export type Span = [number, number];

export interface Scene {
  head: ViewHead;
  details: Details | undefined;
  whole: Window | undefined; ///< all of it, coarsely
  data: Window | undefined; ///< what is in view
  all: Span;
  view: Span;
  stretch: Span | undefined; ///< chosen, or being chosen
  zoom: Span | undefined; ///< being drawn up
  cursors: (number | undefined)[];
  pointer: number | undefined;
}

export const left = 44; // px of the value axis within each canvas

export const plotWidth = (canvas: HTMLCanvasElement): number => Math.max(1, canvas.clientWidth - left - 6);
const px = (t: number, span: Span, width: number): number => left + ((t - span[0]) / (span[1] - span[0])) * width;
export const timeAt = (x: number, span: Span, width: number): number => span[0] + ((x - left) / width) * (span[1] - span[0]);

export interface Surface {
  ctx: CanvasRenderingContext2D;
  width: number; ///< of the plot
  height: number;
}

export function surface(canvas: HTMLCanvasElement): Surface | undefined {
  const { clientWidth, clientHeight: height } = canvas;
  const ctx = canvas.getContext("2d");
  if (!ctx || clientWidth === 0) return undefined;
  const ratio = devicePixelRatio;
  if (canvas.width !== Math.round(clientWidth * ratio) || canvas.height !== Math.round(height * ratio)) {
    canvas.width = Math.round(clientWidth * ratio);
    canvas.height = Math.round(height * ratio);
  }
  ctx.setTransform(ratio, 0, 0, ratio, 0, 0);
  ctx.clearRect(0, 0, clientWidth, height);
  ctx.font = `11px ${colour("sans")}`;
  return { ctx, width: plotWidth(canvas), height };
}

const inkOf = (scene: Scene, channel: number): string => channelInk(scene.head.channels[channel]?.name ?? "", channel);

function gapsIn(scene: Scene, span: Span): Span[] {
  return (scene.details?.json?.timing.gaps ?? []).map((gap): Span => [gap.start_s, gap.start_s + gap.duration_s]).filter((gap) => gap[1] > span[0] && gap[0] < span[1]);
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
function curve(scene: Scene, ctx: CanvasRenderingContext2D, from: Window, channel: number, x: (t: number) => number, y: (v: number) => number): void {
  const min = from.min[channel] ?? [];
  const max = from.samples ? min : (from.max[channel] ?? min);
  const gaps = gapsIn(scene, [from.t[0] ?? 0, from.t.at(-1) ?? 0]);
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

// Smallest and largest value in view, with some room.
function ends(scene: Scene, channel: number): Span {
  const { data, view } = scene;
  let low = Infinity;
  let high = -Infinity;
  data?.t.forEach((t, k) => {
    if (t < view[0] - (view[1] - view[0]) * 0.01 || t > view[1]) return;
    for (const value of [data.min[channel]?.[k], data.samples ? undefined : data.max[channel]?.[k]])
      if (value !== null && value !== undefined) {
        low = Math.min(low, value);
        high = Math.max(high, value);
      }
  });
  if (!(low <= high)) return [-1, 1];
  const room = (high - low) * 0.06 || Math.abs(high) * 1e-3 || 1e-6;
  return [low - room, high + room];
}

function fill(ctx: CanvasRenderingContext2D, span: Span, view: Span, width: number, height: number): Span {
  const at: Span = [px(span[0], view, width), px(span[1], view, width)];
  ctx.fillRect(at[0], 0, at[1] - at[0], height);
  return at;
}

// Rests, the stretch, gaps and the zoom that is being drawn up.
function under(scene: Scene, { ctx, width, height }: Surface): void {
  const { view } = scene;
  ctx.fillStyle = colour("rest");
  for (const rest of scene.head.rests ?? []) if (rest[1] > view[0] && rest[0] < view[1]) fill(ctx, rest, view, width, height);
  ctx.fillStyle = colour("stretch");
  if (scene.zoom) fill(ctx, scene.zoom, view, width, height);
  if (scene.stretch) {
    const at = fill(ctx, scene.stretch, view, width, height);
    ctx.fillStyle = colour("blue");
    for (const x of at) ctx.fillRect(x, 0, 1, height);
  }
  for (const gap of gapsIn(scene, view)) hatch(ctx, px(gap[0], view, width), px(gap[1], view, width), height);
}

function over(scene: Scene, { ctx, width, height }: Surface): void {
  const { view } = scene;
  ctx.fillStyle = colour("ink");
  for (const cursor of scene.cursors) if (cursor !== undefined && cursor >= view[0] && cursor <= view[1]) ctx.fillRect(px(cursor, view, width), 0, 1, height);
  if (scene.pointer === undefined) return;
  ctx.fillStyle = colour("mark");
  ctx.fillRect(px(scene.pointer, view, width), 0, 1, height);
}

// The limits of the range, and the readings at them.
function clipping(scene: Scene, { ctx, width }: Surface, channel: number, y: (v: number) => number): void {
  const audit = scene.details?.json?.channels.find((one) => one.name === scene.head.channels[channel]?.name);
  const { data, view } = scene;
  if (!audit || audit.clipped === 0 || !data) return;
  const sides: [number | null, (number | null)[] | undefined, number][] = [
    [audit.limit_low, data.min[channel], -1],
    [audit.limit_high, (data.samples ? data.min : data.max)[channel], 1],
  ];
  for (const [limit, values, sign] of sides) {
    if (limit === null) continue;
    ctx.setLineDash([4, 3]);
    ctx.strokeStyle = ctx.fillStyle = colour("red");
    ctx.beginPath();
    ctx.moveTo(left, y(limit));
    ctx.lineTo(left + width, y(limit));
    ctx.stroke();
    ctx.setLineDash([]);
    values?.forEach((value, k) => {
      if (value !== null && sign * (value - limit) >= 0) ctx.fillRect(px(data.t[k] ?? 0, view, width) - 2, y(limit) - 2, 4, 4);
    });
  }
}

/// `scale` turns the channel's unit into the one that is shown.
export function drawStrip(scene: Scene, canvas: HTMLCanvasElement, channel: number, scale: number): void {
  const on = surface(canvas);
  if (!on) return;
  const { ctx, width, height } = on;
  const { view, data } = scene;
  const [low, high] = ends(scene, channel);
  const y = (value: number): number => height - 4 - ((value - low) / (high - low)) * (height - 8);
  under(scene, on);
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
  ctx.strokeStyle = colour(inkOf(scene, channel));
  ctx.lineWidth = 1;
  if (data) curve(scene, ctx, data, channel, (t) => px(t, view, width), y);
  clipping(scene, on, channel, y);
  ctx.restore();
  over(scene, on);
}

/// The value nearest to a time, the middle where a column has several; NaN where there is none.
export function valueAt(data: Window | undefined, t: number, channel: number): number {
  if (!data || data.t.length === 0) return NaN;
  let best = 0;
  data.t.forEach((one, k) => {
    if (Math.abs(one - t) < Math.abs((data.t[best] ?? Infinity) - t)) best = k;
  });
  const low = data.min[channel]?.[best];
  const high = data.samples ? low : data.max[channel]?.[best];
  return low === null || high === null || low === undefined || high === undefined ? NaN : (low + high) / 2;
}

export function drawOverview(scene: Scene, canvas: HTMLCanvasElement, channels: number[]): void {
  const on = surface(canvas);
  if (!on) return;
  const { ctx, width, height } = on;
  const { whole, all, view } = scene;
  ctx.globalAlpha = 0.5;
  for (const channel of whole ? channels : []) {
    let low = Infinity;
    let high = -Infinity;
    whole?.min[channel]?.forEach((value) => value !== null && (low = Math.min(low, value)));
    (whole?.samples ? whole.min : whole?.max)?.[channel]?.forEach((value) => value !== null && (high = Math.max(high, value)));
    ctx.strokeStyle = colour(inkOf(scene, channel));
    if (whole) curve(scene, ctx, whole, channel, (t) => px(t, all, width), (value) => height - 5 - ((value - low) / (high - low || 1)) * (height - 10));
  }
  ctx.globalAlpha = 1;
  for (const gap of gapsIn(scene, all)) hatch(ctx, px(gap[0], all, width), px(gap[1], all, width), height);
  const x0 = px(view[0], all, width);
  const x1 = Math.max(x0 + 3, px(view[1], all, width));
  ctx.strokeStyle = ctx.fillStyle = colour("ink");
  ctx.lineWidth = 1;
  ctx.strokeRect(x0 + 0.5, 0.5, x1 - x0 - 1, height - 1);
  ctx.fillRect(x0 - 1, height / 2 - 7, 3, 14);
  ctx.fillRect(x1 - 2, height / 2 - 7, 3, 14);
}

function drawRests(scene: Scene, { ctx, width, height }: Surface): void {
  const { view } = scene;
  (scene.head.rests ?? []).forEach((rest, k) => {
    if (rest[1] < view[0] || rest[0] > view[1]) return;
    const x0 = Math.max(left, px(rest[0], view, width));
    const x1 = Math.min(left + width, px(rest[1], view, width));
    ctx.fillStyle = colour("green");
    ctx.fillRect(x0, height - 3, x1 - x0, 2);
    const word = `rest ${k + 1}`;
    if (ctx.measureText(word).width > x1 - x0 - 4) return;
    ctx.fillStyle = colour("ink");
    ctx.fillText(word, (x0 + x1) / 2, height - 9);
  });
}

/// Rests, knocks and the cursors' heads.
export function drawLane(scene: Scene, canvas: HTMLCanvasElement): void {
  const on = surface(canvas);
  if (!on) return;
  const { ctx, width } = on;
  const { view } = scene;
  ctx.textAlign = "center";
  under(scene, on);
  drawRests(scene, on);
  ctx.fillStyle = colour("purple");
  for (const knock of scene.head.knocks_s ?? []) {
    if (knock < view[0] || knock > view[1]) continue;
    const x = px(knock, view, width);
    ctx.beginPath();
    ctx.moveTo(x - 4, 2);
    ctx.lineTo(x + 4, 2);
    ctx.lineTo(x, 9);
    ctx.fill();
  }
  scene.cursors.forEach((cursor, k) => {
    if (cursor === undefined || cursor < view[0] || cursor > view[1]) return;
    const x = px(cursor, view, width);
    ctx.fillStyle = colour("ink");
    ctx.fillRect(x - 7, 0, 15, 14);
    ctx.fillStyle = colour("paper");
    ctx.fillText("AB".charAt(k), x + 0.5, 11);
  });
}

export function drawTime(scene: Scene, canvas: HTMLCanvasElement): void {
  const on = surface(canvas);
  if (!on) return;
  const { ctx, width } = on;
  const grid = ticks(scene.view[0], scene.view[1], width / 90);
  ctx.fillStyle = colour("soft");
  ctx.textAlign = "center";
  for (const value of grid.values) ctx.fillText(fixed(value, grid.decimals), px(value, scene.view, width), 12);
  ctx.textAlign = "right";
  ctx.fillText(scene.head.rate_hz === 0 ? "Sample" : "Time since the first sample (s)", left + width, 30);
}
