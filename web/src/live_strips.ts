// The strips of a live source: the last seconds of each channel, newest at the right.
import { colour, h } from "./dom";
import { fixed, plain, significant, ticks } from "./format";
import { channelInk } from "./inks";
import type { Head } from "./live_api";
import type { Ring, Slice } from "./ring";
import { left, plotWidth, surface } from "./strips";

interface Strip {
  channel: number;
  canvas: HTMLCanvasElement;
  value: HTMLElement;
}

export interface LiveStrips {
  element: HTMLElement;
  draw: (ring: Ring, until: number, seconds: number, gaps: number[]) => void;
}

const mostStrips = (): number => (innerWidth <= 700 ? 3 : 12);

// Smallest and largest value, with some room.
function ends(slice: Slice, channel: number): [number, number] {
  let low = Infinity;
  let high = -Infinity;
  for (let k = 0; k < slice.length; ++k) {
    const min = slice.min(channel, k);
    const max = slice.max(channel, k);
    if (min < low) low = min;
    if (max > high) high = max;
  }
  if (!(low <= high)) return [-1, 1];
  const space = (high - low) * 0.06 || Math.abs(high) * 1e-3 || 1e-6;
  return [low - space, high + space];
}

function curve(ctx: CanvasRenderingContext2D, slice: Slice, channel: number, x: (t: number) => number, y: (v: number) => number, gaps: number[]): void {
  let before = NaN;
  let gap = 0;
  ctx.beginPath();
  for (let k = 0; k < slice.length; ++k) {
    const t = slice.t(k);
    const low = slice.min(channel, k);
    const high = slice.max(channel, k);
    let isBroken = Number.isNaN(before);
    for (; gap < gaps.length && (gaps[gap] as number) < t; ++gap) isBroken ||= k > 0 && (gaps[gap] as number) >= slice.t(k - 1);
    if (Number.isNaN(low)) {
      before = NaN;
      continue;
    }
    const at = x(t);
    if (isBroken) ctx.moveTo(at, y(low));
    else ctx.lineTo(at, y(Math.abs(low - before) < Math.abs(high - before) ? low : high));
    if (high !== low) {
      ctx.moveTo(at, y(low));
      ctx.lineTo(at, y(high));
    }
    before = high;
  }
  ctx.stroke();
}

function drawOne(strip: Strip, head: Head, slice: Slice, until: number, seconds: number, gaps: number[]): void {
  const on = surface(strip.canvas);
  if (!on) return;
  const { ctx, width, height } = on;
  const [low, high] = ends(slice, strip.channel);
  const y = (value: number): number => height - 4 - ((value - low) / (high - low)) * (height - 8);
  const x = (t: number): number => left + width - ((until - t) / seconds) * width;
  ctx.textAlign = "right";
  const grid = ticks(low, high, height / 34);
  for (const value of grid.values) {
    ctx.fillStyle = colour("grid");
    ctx.fillRect(left, y(value), width, 1);
    ctx.fillStyle = colour("soft");
    ctx.fillText(fixed(value, grid.decimals), left - 6, y(value) + 4);
  }
  ctx.save();
  ctx.beginPath();
  ctx.rect(left, 0, width, height);
  ctx.clip();
  ctx.fillStyle = colour("red");
  for (const gap of gaps) if (gap > until - seconds && gap <= until) ctx.fillRect(x(gap), 0, 1, height);
  ctx.strokeStyle = colour(channelInk(head.channels[strip.channel]?.name ?? "", strip.channel));
  ctx.lineWidth = 1;
  curve(ctx, slice, strip.channel, x, y, gaps);
  ctx.restore();
}

function drawTime(canvas: HTMLCanvasElement, seconds: number): void {
  const on = surface(canvas);
  if (!on) return;
  const grid = ticks(-seconds, 0, on.width / 80);
  on.ctx.fillStyle = colour("soft");
  on.ctx.textAlign = "center";
  for (const value of grid.values) on.ctx.fillText(fixed(value, grid.decimals), left + on.width + (value / seconds) * on.width, 12);
  on.ctx.textAlign = "right";
  on.ctx.fillText("Time before now (s)", left + on.width, 30);
}

/// The accelerations first, as many as there is room for.
export function liveStrips(head: Head): LiveStrips {
  const all = head.channels.map((_, k) => k);
  const isAcceleration = (k: number): boolean => head.channels[k]?.is_acceleration ?? false;
  const chosen = [...all.filter(isAcceleration), ...all.filter((k) => !isAcceleration(k))].slice(0, mostStrips()).sort((a, b) => a - b);
  const strips: Strip[] = chosen.map((channel) => {
    const name = head.channels[channel]?.name ?? "";
    const canvas = h("canvas", { role: "img", "aria-label": `${name}, the last seconds` });
    canvas.style.height = `${innerWidth <= 700 ? 76 : 92}px`;
    return { channel, canvas, value: h("span", { class: "now" }) };
  });
  const time = h("canvas", { "aria-hidden": "true" });
  time.style.height = "34px";
  const element = h(
    "div",
    { class: "live-strips" },
    ...strips.map((one) => {
      const channel = head.channels[one.channel];
      return h("div", { class: "strip" }, h("div", { class: "label" }, h("b", {}, channel?.name ?? ""), one.value, h("span", {}, plain(channel?.unit ?? ""))), one.canvas);
    }),
    h("div", { class: "strip" }, h("div", { class: "label" }), time),
  );
  const draw = (ring: Ring, until: number, seconds: number, gaps: number[]): void => {
    const slice = ring.since(until - seconds, 4 * Math.max(200, plotWidth(time)));
    for (const one of strips) {
      drawOne(one, head, slice, until, seconds, gaps);
      const last = slice.length - 1;
      one.value.textContent = last >= 0 ? significant((slice.min(one.channel, last) + slice.max(one.channel, last)) / 2, 4) : "";
    }
    drawTime(time, seconds);
  };
  return { element, draw };
}
