// The live estimates: a wheel's angle, a tilt, a displacement, each with its 95 % limits.
import { bubble, course, dial, vernier } from "./dial";
import { h, replace } from "./dom";
import { fixed, significant } from "./format";
import type { LiveChannel } from "./live_api";

const normal95 = 1.96;
const degrees = 180 / Math.PI;
const rpm = 30 / Math.PI;

interface Known {
  t: number;
  value: (name: string) => number;
}

export interface EstimatePanel {
  element: HTMLElement;
  add: (t: number, values: (number | null)[]) => void;
  draw: () => void;
}

// As many decimals as the limits have two figures.
function withLimits(value: number, std: number, unit: string): HTMLElement {
  if (!Number.isFinite(value)) return h("div", { class: "big" }, "–");
  const limit = normal95 * std;
  if (!Number.isFinite(limit) || limit <= 0) return h("div", { class: "big" }, significant(value, 5), h("small", {}, ` ${unit}`));
  const decimals = Math.min(9, Math.max(0, 1 - Math.floor(Math.log10(limit))));
  return h("div", { class: "big" }, fixed(value, decimals), h("small", {}, ` ± ${limit.toFixed(decimals)} ${unit}`));
}

const figure = (title: string, value: HTMLElement, ...more: (Node | false)[]): HTMLElement => h("div", {}, h("h3", {}, title), value, ...more);

function drawWheel(now: Known, past: Known[]): Node[] {
  const angle = now.value("angle");
  if (!Number.isFinite(angle)) return [h("p", { class: "soft" }, "The first seconds determine the wheel's plane and phase.")];
  const std = now.value("angle_std");
  const deg = ((((angle * degrees) % 360) + 360) % 360);
  const scale = vernier(deg, std * degrees);
  const speeds = past.map((one) => ({ t: one.t, value: one.value("speed") * rpm, std: one.value("speed_std") * rpm }));
  return [
    h(
      "div",
      { class: "dial-grid" },
      dial(deg, std * degrees),
      h(
        "div",
        { class: "readings" },
        figure(angle < 0 ? "Turns, backwards" : "Turns, forwards", withLimits(Math.abs(angle) / (2 * Math.PI), std / (2 * Math.PI), "")),
        figure("Speed", withLimits(now.value("speed") * rpm, now.value("speed_std") * rpm, "rpm"), course(speeds, "Speed, the last seconds")),
        figure("Angle", withLimits(deg, std * degrees, "°")),
      ),
    ),
    h("div", { class: "vernier-words" }, h("span", {}, `error band × ${significant(Math.max(1, scale.factor), 2)}: 1 and 2 standard deviations`)),
    scale.element as unknown as HTMLElement,
  ];
}

function drawTilt(now: Known): Node[] {
  const roll = now.value("roll") * degrees;
  const pitch = now.value("pitch") * degrees;
  const rollStd = now.value("roll_std") * degrees;
  const pitchStd = now.value("pitch_std") * degrees;
  if (!Number.isFinite(pitch)) return [h("p", { class: "soft" }, "The first second determines the noise.")];
  return [h("div", { class: "dial-grid" }, bubble(roll, pitch, rollStd, pitchStd), h("div", { class: "readings" }, figure("Roll", withLimits(roll, rollStd, "°")), figure("Pitch", withLimits(pitch, pitchStd, "°"))))];
}

function drawTrack(now: Known, past: Known[]): Node[] {
  const position = now.value("position");
  if (!Number.isFinite(position)) return [h("p", { class: "soft" }, "The recording begins with three seconds at rest; the first motion determines the axis.")];
  const places = past.map((one) => ({ t: one.t, value: one.value("position"), std: one.value("position_std") }));
  return [
    h(
      "div",
      { class: "readings" },
      figure("Position, from the first rest", withLimits(1000 * position, 1000 * now.value("position_std"), "mm"), course(places, "Position, the last seconds")),
      figure("Velocity", withLimits(1000 * now.value("velocity"), 1000 * now.value("velocity_std"), "mm/s")),
      figure("State", h("div", { class: "big" }, now.value("resting") === 1 ? "at rest" : "moving")),
    ),
  ];
}

export function estimatePanel(columns: LiveChannel[], what: string): EstimatePanel {
  const most = 600; // of the last seconds, 25 a second
  const past: Known[] = [];
  const body = h("div", { class: "pb" }, h("p", { class: "soft" }, "No estimate yet: the filter is being started."));
  const title = { wheel: "Wheel", tilt: "Tilt", track: "Displacement" }[what] ?? "Estimate";
  const element = h("section", { class: "panel", "aria-label": title }, h("div", { class: "ph" }, h("h2", {}, title), h("span", { class: "soft" }, "95 % limits")), body);
  const add = (t: number, values: (number | null)[]): void => {
    past.push({ t, value: (name) => values[columns.findIndex((one) => one.name === name)] ?? NaN });
    if (past.length > most) past.shift();
  };
  const draw = (): void => {
    const now = past.at(-1);
    if (!now) return;
    element.dataset["time"] = String(now.t);
    const last = past.filter((one) => one.t > now.t - 12);
    if (what === "wheel") {
      element.dataset["angle"] = String(now.value("angle"));
      element.dataset["std"] = String(now.value("angle_std"));
      replace(body, ...drawWheel(now, last));
    } else replace(body, ...(what === "tilt" ? drawTilt(now) : drawTrack(now, last)));
  };
  return { element, add, draw };
}
