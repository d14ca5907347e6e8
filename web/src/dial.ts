// Instruments of the live estimates: the wheel's dial with its vernier, the bubble of a level, the
// course of a displacement.
import { svg } from "./dom";
import { fixed } from "./format";

const polar = (cx: number, cy: number, r: number, deg: number): [number, number] => {
  const angle = (deg * Math.PI) / 180;
  return [cx + r * Math.cos(angle), cy - r * Math.sin(angle)];
};

/// A needle with a wedge of ±2 standard deviations.
export function dial(deg: number, std: number): SVGElement {
  const c = 104;
  const r = 88;
  const marks: SVGElement[] = [];
  for (let k = 0; k < 360; k += 10) {
    const [x1, y1] = polar(c, c, r, k);
    const [x2, y2] = polar(c, c, r - (k % 30 ? 5 : k % 90 ? 9 : 12), k);
    marks.push(svg("line", { x1, y1, x2, y2, class: "tick" }));
  }
  for (const k of [0, 90, 180, 270]) {
    const [x, y] = polar(c, c, r - 25, k);
    marks.push(svg("text", { x, y: y + 4, "text-anchor": "middle" }, `${k}°`));
  }
  const half = Math.min(180, Math.max(2 * std, 0.9));
  const [px, py] = polar(c, c, r - 2, deg - half);
  const [qx, qy] = polar(c, c, r - 2, deg + half);
  const [nx, ny] = polar(c, c, r - 2, deg);
  const [tx, ty] = polar(c, c, -18, deg);
  const wedge = half >= 179 ? svg("circle", { cx: c, cy: c, r: r - 2, class: "band" }) : svg("path", { d: `M${c} ${c}L${px} ${py}A${r - 2} ${r - 2} 0 ${half > 90 ? 1 : 0} 0 ${qx} ${qy}Z`, class: "band" });
  return svg(
    "svg",
    { viewBox: "0 0 208 208", class: "dial", role: "img", "aria-label": `Wheel at ${fixed(deg, 1)} degrees` },
    svg("circle", { cx: c, cy: c, r, class: "rim" }),
    ...marks,
    wedge,
    svg("line", { x1: tx, y1: ty, x2: nx, y2: ny, class: "needle" }),
    svg("circle", { cx: c, cy: c, r: 4, class: "hub" }),
  );
}

/// The neighbourhood of the angle, magnified so that its error band is seen.
export function vernier(deg: number, std: number): { element: SVGElement; factor: number } {
  const width = 400;
  const middle = width / 2;
  const half = [0.001, 0.002, 0.005, 0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1, 2, 5, 10, 20, 45, 90, 180].find((one) => one >= 4 * std) ?? 180;
  const scale = middle / half;
  const step = half / 5;
  const decimals = Math.max(0, -Math.floor(Math.log10(step) + 1e-9));
  const parts: SVGElement[] = [];
  for (let k = Math.ceil((deg - half) / step); k * step <= deg + half; ++k) {
    const x = middle + (k * step - deg) * scale;
    const isLabelled = k % 2 === 0;
    parts.push(svg("line", { x1: x, x2: x, y1: isLabelled ? 18 : 22, y2: 28, class: "tick" }));
    if (isLabelled && x > 24 && x < width - 24) parts.push(svg("text", { x, y: 12, "text-anchor": "middle" }, `${fixed((((k * step) % 360) + 360) % 360, decimals)}°`));
  }
  const band = (sigmas: number): SVGElement => svg("rect", { x: middle - sigmas * std * scale, y: 28, width: 2 * sigmas * std * scale, height: 16, class: "band" });
  const element = svg("svg", { viewBox: `0 0 ${width} 46`, class: "vernier", role: "img", "aria-label": "Error band: one and two standard deviations" }, band(2), band(1), svg("line", { x1: 0, x2: width, y1: 28, y2: 28, class: "tick" }), ...parts, svg("line", { x1: middle, x2: middle, y1: 16, y2: 44, class: "needle" }));
  // On the dial a degree is 88 · π/180 px of 208.
  return { element, factor: scale / ((88 * Math.PI) / 180) };
}

/// Roll to the right and pitch upwards, as a bubble sees them; the ellipse is ±2 standard deviations.
export function bubble(roll: number, pitch: number, rollStd: number, pitchStd: number): SVGElement {
  const c = 104;
  const r = 88;
  const full = [1, 2, 5, 10, 20, 45, 90, 180].find((one) => one >= Math.max(Math.abs(roll), Math.abs(pitch))) ?? 180;
  const at = (angle: number): number => (angle / full) * (r - 10);
  const x = c + at(roll);
  const y = c - at(pitch);
  return svg(
    "svg",
    { viewBox: "0 0 208 208", class: "dial", role: "img", "aria-label": `Roll ${fixed(roll, 2)} degrees, pitch ${fixed(pitch, 2)} degrees` },
    svg("circle", { cx: c, cy: c, r, class: "rim" }),
    svg("circle", { cx: c, cy: c, r: (r - 10) / 2, class: "rim" }),
    svg("path", { d: `M${c - r} ${c}H${c + r}M${c} ${c - r}V${c + r}`, class: "rim" }),
    svg("text", { x: c + r - 4, y: c - 6, "text-anchor": "end" }, `${full}°`),
    svg("ellipse", { cx: x, cy: y, rx: Math.max(3, at(2 * rollStd)), ry: Math.max(3, at(2 * pitchStd)), class: "band" }),
    svg("circle", { cx: x, cy: y, r: 7, class: "hub" }),
  );
}

/// The last values of a quantity with their band of ±2 standard deviations.
export function course(points: { t: number; value: number; std: number }[], label: string): SVGElement {
  const width = 400;
  const height = 60;
  const known = points.filter((one) => Number.isFinite(one.value));
  const low = Math.min(...known.map((one) => one.value - 2 * (one.std || 0)));
  const high = Math.max(...known.map((one) => one.value + 2 * (one.std || 0)));
  const t0 = known[0]?.t ?? 0;
  const t1 = known.at(-1)?.t ?? 1;
  const x = (t: number): string => (((t - t0) / (t1 - t0 || 1)) * width).toFixed(1);
  const y = (value: number): string => (height - 3 - ((value - low) / (high - low || 1)) * (height - 6)).toFixed(1);
  const line = known.map((one) => `${x(one.t)} ${y(one.value)}`).join("L");
  const band = [...known.map((one) => `${x(one.t)} ${y(one.value + 2 * (one.std || 0))}`), ...known.reverse().map((one) => `${x(one.t)} ${y(one.value - 2 * (one.std || 0))}`)].join("L");
  return svg("svg", { viewBox: `0 0 ${width} ${height}`, class: "course", role: "img", "aria-label": label, preserveAspectRatio: "none" }, known.length > 1 && svg("path", { d: `M${band}Z`, class: "band" }), known.length > 1 && svg("path", { d: `M${line}`, class: "line" }));
}
