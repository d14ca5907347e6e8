// A sensor drawn as it lies: a box with its axes, turned so that the direction given is up. How it is
// turned about the vertical cannot be seen by an accelerometer: the shortest way from +z up is drawn.
import { svg } from "./dom";

type Vector = [number, number, number];
type Rotation = [Vector, Vector, Vector];

const dot = (a: Vector, b: Vector): number => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const turned = (by: Rotation, v: Vector): Vector => [dot(by[0], v), dot(by[1], v), dot(by[2], v)];

/// The rotation by the shortest way that takes the unit vector u to +z (Rodrigues' formula); half a turn about x
/// if u is −z.
function upright(u: Vector): Rotation {
  const [x, y, z] = u;
  if (z < -0.9999) return [[1, 0, 0], [0, -1, 0], [0, 0, -1]];
  const k = 1 / (1 + z);
  return [[1 - k * x * x, -k * x * y, -x], [-k * x * y, 1 - k * y * y, -y], [x, y, z]];
}

// Seen from the front, to the right, and above.
const azimuth = (-25 * Math.PI) / 180;
const elevation = (20 * Math.PI) / 180;
const camera: Rotation = [
  [Math.cos(azimuth), -Math.sin(azimuth), 0],
  [Math.sin(elevation) * Math.sin(azimuth), Math.sin(elevation) * Math.cos(azimuth), Math.cos(elevation)],
  [-Math.cos(elevation) * Math.sin(azimuth), -Math.cos(elevation) * Math.cos(azimuth), Math.sin(elevation)],
];

const half: Vector = [30, 22, 9];
const names = ["x", "y", "z"];
const inks = ["blue", "orange", "green"];

export function orientation(up: Vector | null, word: string, isWanted: boolean): SVGElement {
  const parts: SVGElement[] = [];
  const text = (at: Vector, words: string, cls: string): SVGElement => svg("text", { x: 70 + at[0], y: 62 - at[1] + 4, "text-anchor": "middle", class: cls }, words);
  if (up) {
    const by = upright(up);
    const seen = (v: Vector): Vector => turned(camera, turned(by, v));
    const along = (axis: number, length: number): Vector => [0, 1, 2].map((k) => (k === axis ? length : 0)) as Vector;
    const arrows = [0, 1, 2].map((axis) => ({ axis, from: seen(along(axis, half[axis] as number)), to: seen(along(axis, (half[axis] as number) + 18)), label: seen(along(axis, (half[axis] as number) + 27)) }));
    const arrow = (one: (typeof arrows)[number]): SVGElement[] => [
      svg("line", { x1: 70 + one.from[0], y1: 62 - one.from[1], x2: 70 + one.to[0], y2: 62 - one.to[1], class: `axis ${inks[one.axis]}` }),
      svg("circle", { cx: 70 + one.to[0], cy: 62 - one.to[1], r: 2.5, class: `tip ${inks[one.axis]}` }),
    ];
    // Axes that point away are behind the box.
    for (const one of arrows) if (one.to[2] < one.from[2]) parts.push(...arrow(one));
    for (let axis = 0; axis < 3; ++axis)
      for (const sign of [-1, 1]) {
        if (seen(along(axis, sign))[2] <= 0) continue;
        const [i, j] = [(axis + 1) % 3, (axis + 2) % 3] as [number, number];
        const corners = [[-1, -1], [1, -1], [1, 1], [-1, 1]].map(([a, b]) => {
          const corner: Vector = [0, 0, 0];
          corner[axis] = sign * (half[axis] as number);
          corner[i] = (a as number) * (half[i] as number);
          corner[j] = (b as number) * (half[j] as number);
          return seen(corner);
        });
        parts.push(svg("path", { d: `M${corners.map((at) => `${(70 + at[0]).toFixed(1)} ${(62 - at[1]).toFixed(1)}`).join("L")}Z`, class: "face" }));
        // The other ends of the axes, where the face is not too narrow to be written on.
        if (sign < 0 && seen(along(axis, -1))[2] > 0.4) parts.push(text(seen(along(axis, -(half[axis] as number))), `−${names[axis]}`, "side"));
      }
    for (const one of arrows) if (one.to[2] >= one.from[2]) parts.push(...arrow(one));
    for (const one of arrows) parts.push(text(one.label, `+${names[one.axis]}`, `name ${inks[one.axis]}`));
  } else {
    parts.push(text([0, 0, 0], "not known yet", "side"));
  }
  return svg(
    "svg",
    { viewBox: "0 0 170 130", class: "orientation", role: "img", "aria-label": up ? `The sensor ${word}` : `The sensor ${word}: not known yet` },
    svg("text", { x: 70, y: 12, "text-anchor": "middle", class: isWanted ? "caption wanted" : "caption" }, word),
    ...parts,
    svg("path", { d: "M150 84V44M145 51l5 -8l5 8", class: "upwards" }),
    svg("text", { x: 150, y: 98, "text-anchor": "middle", class: "side" }, "up"),
  );
}
