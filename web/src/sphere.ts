// Directions of a guided calibration: two Lambert (equal-area) hemispheres of which way is up in the
// sensor's axes.
import { svg } from "./dom";
import type { Guide, Maps } from "./live_api";

type Direction = [number, number, number];

const radius = 132;
const middle = 150;

function place(up: Direction, isLower: boolean): [number, number] {
  const z = isLower ? -up[2] : up[2];
  const angle = Math.acos(Math.max(-1, Math.min(1, z)));
  const r = radius * Math.SQRT2 * Math.sin(angle / 2);
  const flat = Math.hypot(up[0], up[1]) || 1;
  return [middle + ((isLower ? -up[0] : up[0]) / flat) * r, middle - (up[1] / flat) * r];
}

const isOn = (up: Direction, isLower: boolean): boolean => (isLower ? up[2] < 0 : up[2] >= 0);

function candidates(isLower: boolean): SVGElement[] {
  const marks: SVGElement[] = [];
  for (let i = -1; i < 2; ++i)
    for (let j = -1; j < 2; ++j)
      for (let k = -1; k < 2; ++k) {
        const size = Math.hypot(i, j, k);
        if (size === 0 || (isLower ? k > 0 : k < 0)) continue;
        const [x, y] = place([i / size, j / size, k / size], isLower);
        marks.push(svg("path", { d: `M${x - 3} ${y}h6M${x} ${y - 3}v6`, class: "offered" }));
      }
  return marks;
}

function labels(isLower: boolean): SVGElement[] {
  const words: [string, number, number][] = [["+x", radius + 14, 4], ["−x", -radius - 14, 4], ["+y", 0, -radius - 6], ["−y", 0, radius + 15]];
  return words.map(([word, x, y]) => svg("text", { x: middle + (isLower && y === 4 ? -x : x), y: middle + y, "text-anchor": "middle" }, word));
}

function done(guide: Guide, isLower: boolean): SVGElement[] {
  return guide.poses
    .filter((pose) => pose.up !== null && isOn(pose.up, isLower))
    .flatMap((pose) => {
      const [x, y] = place(pose.up as Direction, isLower);
      const mark = pose.is_suspect ? svg("rect", { x: x - 9, y: y - 9, width: 18, height: 18, rx: 2, class: "suspect" }) : svg("circle", { cx: x, cy: y, r: 9, class: "done" });
      return [mark, svg("text", { x, y: y + 4, "text-anchor": "middle", class: pose.is_suspect ? "number on-red" : "number" }, String(pose.number))];
    });
}

// A ring that fills while the position is held.
function now(guide: Guide, isLower: boolean): SVGElement[] {
  if (!guide.now || !isOn(guide.now, isLower)) return [];
  const [x, y] = place(guide.now, isLower);
  const round = 2 * Math.PI * 11;
  return [
    svg("circle", { cx: x, cy: y, r: 11, class: "held-ground" }),
    svg("circle", { cx: x, cy: y, r: 11, class: "held", "stroke-dasharray": `${round * (guide.hold_fraction ?? 0)} ${round}`, transform: `rotate(-90 ${x} ${y})` }),
    svg("circle", { cx: x, cy: y, r: 4, class: "now-dot" }),
    svg("text", { x: x + 17, y: y + 4, class: "halo strong" }, "now"),
  ];
}

function next(guide: Guide, isLower: boolean): SVGElement[] {
  if (!guide.next || !isOn(guide.next, isLower)) return [];
  const [x, y] = place(guide.next, isLower);
  return [
    svg("circle", { cx: x, cy: y, r: 13, class: "next" }),
    svg("circle", { cx: x, cy: y, r: 2.5, class: "next-dot" }),
    svg("text", { x, y: y + 27, "text-anchor": "middle", class: "halo next-word" }, `next ${guide.poses.length + 1}`),
  ];
}

/// Limits of the shades, from the smallest standard deviation to the largest, in g.
export function shadeLevels(maps: Maps): number[] {
  const least = Math.min(...maps.plus_z_g.flat(), ...maps.minus_z_g.flat());
  const bands = 5;
  return Array.from({ length: bands }, (_, k) => least + (k / bands) * (maps.largest_g - least));
}

/// Standard deviation of a measurement of 1 g, in bands, a line of the picture at a time.
export function shading(maps: Maps, isLower: boolean): SVGElement {
  const rows = isLower ? maps.minus_z_g : maps.plus_z_g;
  const last = rows.length - 1;
  const value = (x: number, y: number): number => {
    const [u, v] = [((x / radius + 1) / 2) * last, ((y / radius + 1) / 2) * last];
    const [k, i] = [Math.min(last - 1, Math.floor(u)), Math.min(last - 1, Math.floor(v))];
    const at = (row: number, column: number): number => rows[row]?.[column] ?? 0;
    const [a, b] = [u - k, v - i];
    return (1 - b) * ((1 - a) * at(i, k) + a * at(i, k + 1)) + b * ((1 - a) * at(i + 1, k) + a * at(i + 1, k + 1));
  };
  const step = 2;
  const paths = shadeLevels(maps).slice(1).map((level) => {
    let d = "";
    for (let y = -radius; y < radius; y += step) {
      const edge = Math.sqrt(Math.max(0, radius * radius - (y + step / 2) ** 2));
      let from: number | undefined;
      for (let x = -edge; ; x = Math.min(edge, x + step)) {
        const isOver = x < edge && value(x + step / 2, y + step / 2) >= level;
        if (isOver) from ??= x;
        if (!isOver && from !== undefined) {
          d += `M${(middle + from).toFixed(1)} ${middle - y - step}H${(middle + x).toFixed(1)}v${step}H${(middle + from).toFixed(1)}z`;
          from = undefined;
        }
        if (x >= edge) break;
      }
    }
    return svg("path", { d, class: "shade" });
  });
  return svg("g", {}, ...paths);
}

export function hemisphere(guide: Guide, isLower: boolean, shade: SVGElement | undefined): SVGElement {
  const rings = [30, 60].map((deg) => svg("circle", { cx: middle, cy: middle, r: radius * Math.SQRT2 * Math.sin((deg * Math.PI) / 360), class: "ring" }));
  return svg(
    "svg",
    { viewBox: "-18 -2 336 306", class: "sphere", role: "img", "aria-label": `Directions with ${isLower ? "−z" : "+z"} up: ${guide.poses.length} positions taken` },
    ...(shade ? [shade] : []),
    ...rings,
    svg("circle", { cx: middle, cy: middle, r: radius, class: "edge" }),
    svg("path", { d: `M${middle - radius} ${middle}H${middle + radius}M${middle} ${middle - radius}V${middle + radius}`, class: "ring" }),
    ...labels(isLower),
    ...candidates(isLower),
    ...done(guide, isLower),
    ...next(guide, isLower),
    ...now(guide, isLower),
  );
}

/// Leave-one-out residual with ±2 standard deviations behind it, both in mg, to a scale.
export function residualBar(value: number, std: number, most: number, isSuspect: boolean): SVGElement {
  const width = 260;
  const c = width / 2;
  const scale = c / most;
  const x = c + Math.max(-most, Math.min(most, value)) * scale;
  const half = Math.min(most, 2 * std) * scale;
  return svg(
    "svg",
    { viewBox: `0 0 ${width} 14`, class: "residual", preserveAspectRatio: "none", "aria-hidden": "true" },
    svg("rect", { x: c - half, y: 0, width: 2 * half, height: 14, class: "expected" }),
    svg("line", { x1: c, x2: c, y1: 0, y2: 14, class: "edge" }),
    svg("rect", { x: Math.min(c, x), y: 3, width: Math.max(1.5, Math.abs(x - c)), height: 8, class: isSuspect ? "bad" : "good" }),
  );
}
