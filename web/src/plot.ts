// A figure of the program's own document, drawn live: log axes, bands, readout, zoom, a legend that
// switches curves.
import uPlot from "uplot";
import { blob, type Band, type Curve, type Figure } from "./api";
import { colour, h, save } from "./dom";
import { significant } from "./format";

type Numbers = (number | null | undefined)[];

interface Row {
  label: string;
  ink: string;
  kind: string;
  series: number[]; ///< which it switches, in uPlot's count
  read: (index: number) => string;
  shown: boolean;
}

const positive = (values: (number | null)[], log: boolean): (number | null)[] =>
  log ? values.map((value) => (value !== null && value > 0 ? value : null)) : values;

// One list of x for all curves; a place where a curve has no value is skipped, one where it is
// broken is not.
function aligned(figure: Figure): { data: uPlot.AlignedData; lines: Curve[]; bands: Band[] } {
  const lines = figure.curves.filter((curve) => curve.mark !== "ticks" && curve.y !== undefined);
  const logY = figure.y.scale === "log";
  const tables: uPlot.AlignedData[] = [];
  const add = (x: (number | null)[], ys: (number | null)[][]): void => {
    const keep = x.map((value, k) => ({ value, k })).filter((one) => one.value !== null && (figure.x.scale !== "log" || one.value > 0));
    keep.sort((a, b) => (a.value as number) - (b.value as number));
    const unique = keep.filter((one, k) => k === 0 || one.value !== keep[k - 1]?.value);
    tables.push([
      unique.map((one) => one.value as number),
      ...ys.map((y) => unique.map((one) => positive([y[one.k] ?? null], logY)[0] ?? null)),
    ]);
  };
  for (const curve of lines) add(curve.x, [curve.y ?? []]);
  for (const band of figure.bands) add(band.x, [band.lower, band.upper]);
  const data = tables.length > 0 ? uPlot.join(tables) : ([[]] as uPlot.AlignedData);
  return { data, lines, bands: figure.bands };
}

// Curves that go back and forth in x, and maps, are drawn by hand over an empty grid.
const isMap = (figure: Figure): boolean => figure.x.scale === "bare";

// 1 … 9 times every power of ten.
function logSplits(low: number, high: number): number[] {
  const splits: number[] = [];
  for (let power = Math.floor(Math.log10(low)); power <= Math.log10(high); ++power)
    for (let digit = 1; digit < 10; ++digit) {
      const value = Number(`${digit}e${power}`);
      if (value >= low && value <= high) splits.push(value);
    }
  return splits;
}

// Labels at 1, 2 and 5; over many decades at powers of ten alone.
function logFilter(_: uPlot, splits: number[]): (number | null)[] {
  const decades = Math.log10((splits.at(-1) ?? 1) / (splits[0] ?? 1));
  const wanted = decades > 3.2 ? [1] : [1, 2, 5];
  return splits.map((value) => {
    const power = Math.pow(10, Math.floor(Math.log10(value) + 1e-9));
    return wanted.includes(Math.round(value / power)) ? value : null;
  });
}

function axis(label: string, log: boolean, side: number): uPlot.Axis {
  const made: uPlot.Axis = {
    side,
    stroke: colour("soft"),
    grid: { stroke: colour("grid"), width: 1 },
    ticks: { show: false },
    font: `11px ${colour("sans")}`,
    labelFont: `11px ${colour("sans")}`,
    values: (_, splits) => splits.map((value) => (value === null ? "" : significant(value, 6))),
    size: side === 3 ? 58 : 30,
    gap: 4,
  };
  if (side === 2) {
    made.label = label;
    made.labelSize = 18;
  }
  if (log) {
    made.splits = (_, __, low, high) => logSplits(low, high);
    made.filter = logFilter;
  }
  return made;
}

function strokeOf(ink: string): string {
  return colour(ink) || colour("blue");
}

function dash(mark: string): number[] {
  return mark === "dashes" ? [6, 4] : [];
}

function withAlpha(hex: string, alpha: number): string {
  const value = parseInt(hex.slice(1), 16);
  return `rgba(${value >> 16}, ${(value >> 8) & 255}, ${value & 255}, ${alpha})`;
}

function drawExtras(plot: uPlot, figure: Figure): void {
  const { ctx, bbox } = plot;
  const ratio = devicePixelRatio;
  ctx.save();
  ctx.beginPath();
  ctx.rect(bbox.left, bbox.top, bbox.width, bbox.height);
  ctx.clip();
  ctx.font = `${11 * ratio}px ${colour("sans")}`;
  for (const level of figure.levels) {
    if (level.y === null) continue;
    const y = plot.valToPos(level.y, "y", true);
    ctx.strokeStyle = colour("soft");
    ctx.setLineDash([2 * ratio, 3 * ratio]);
    ctx.beginPath();
    ctx.moveTo(bbox.left, y);
    ctx.lineTo(bbox.left + bbox.width, y);
    ctx.stroke();
    ctx.setLineDash([]);
  }
  for (const curve of figure.curves.filter((one) => one.mark === "ticks")) {
    ctx.strokeStyle = strokeOf(curve.ink);
    ctx.lineWidth = ratio;
    for (const x of curve.x) {
      if (x === null) continue;
      const at = plot.valToPos(x, "x", true);
      ctx.beginPath();
      ctx.moveTo(at, bbox.top + bbox.height);
      ctx.lineTo(at, bbox.top + bbox.height - 9 * ratio);
      ctx.stroke();
    }
  }
  for (const one of figure.callouts) {
    if (one.x === null || one.y === null) continue;
    const x = plot.valToPos(one.x, "x", true);
    const y = plot.valToPos(one.y, "y", true);
    ctx.fillStyle = strokeOf(one.ink);
    if (!one.bare) {
      ctx.beginPath();
      ctx.arc(x, y, 3 * ratio, 0, 2 * Math.PI);
      ctx.fill();
    }
    const width = ctx.measureText(one.text).width;
    const left = one.left || x + width + 10 * ratio > bbox.left + bbox.width;
    ctx.textAlign = one.bare ? "center" : left ? "right" : "left";
    ctx.fillText(one.text, one.bare ? x : x + (left ? -6 : 6) * ratio, y + (one.bare ? 4 : one.below ? 15 : -6) * ratio);
  }
  ctx.restore();
}

function seriesOf(curve: Curve): uPlot.Series {
  const points = curve.mark === "points";
  return {
    label: curve.label,
    stroke: strokeOf(curve.ink),
    width: curve.mark === "thin" ? 1 : points ? 0 : 1.5,
    dash: dash(curve.mark),
    points: { show: points, size: 6, fill: strokeOf(curve.ink), stroke: strokeOf(curve.ink) },
    spanGaps: false,
  };
}

function range(figure: Figure, which: "x" | "y"): uPlot.Scale.Range {
  const wanted = figure[which];
  if (wanted.scale === "log") {
    return (_, low, high) => {
      const from = wanted.min ?? low;
      const to = wanted.max ?? high;
      if (!(from > 0) || !(to > from)) return [from > 0 ? from / 2 : 0.1, from > 0 ? from * 2 : 1];
      const room = which === "y" ? Math.pow(to / from, 0.05) : 1;
      return [wanted.min ?? from / room, wanted.max ?? to * room];
    };
  }
  return (_, low, high) => {
    const from = wanted.min ?? low;
    const to = wanted.max ?? high;
    const room = which === "y" ? 0.05 * (to - from) || Math.abs(to) * 1e-3 || 1e-9 : to > from ? 0 : 0.5;
    return [wanted.min ?? from - room, wanted.max ?? to + room];
  };
}

/// Where nobody points: the minimum of the first curve of a log plot, else its end.
function restingIndex(data: uPlot.AlignedData, log: boolean): number {
  const first = (data[1] ?? []) as Numbers;
  let best = -1;
  first.forEach((value, k) => {
    if (value === null || value === undefined) return;
    if (best < 0 || !log || value < (first[best] as number)) best = k;
  });
  return Math.max(0, best);
}

// The value at a place, or at the nearest that has one.
function nearest(values: Numbers, index: number): number | undefined {
  for (let away = 0; away < values.length; ++away)
    for (const k of [index - away, index + away]) {
      const value = values[k];
      if (value !== null && value !== undefined) return value;
    }
  return undefined;
}

export interface Drawn {
  element: HTMLElement;
  dispose: () => void;
}

export interface PlotOptions {
  height?: number;
  below?: boolean; ///< the legend stands below the plot
  actions?: { name: string; act: () => void }[];
}

function rowsOf(figure: Figure, data: uPlot.AlignedData, lines: Curve[], bands: Band[]): Row[] {
  const rows: Row[] = [];
  const value = (series: number, index: number): string => significant(nearest(data[series] as Numbers, index), 4);
  lines.forEach((curve, k) => {
    if (curve.label) rows.push({ label: curve.label, ink: curve.ink, kind: curve.mark, series: [k + 1], read: (index) => value(k + 1, index), shown: true });
  });
  bands.forEach((band, k) => {
    const low = lines.length + 1 + 2 * k;
    if (band.label) rows.push({ label: band.label, ink: band.ink, kind: "band", series: [low, low + 1], read: (index) => `${value(low, index)} … ${value(low + 1, index)}`, shown: true });
  });
  for (const level of figure.levels)
    if (level.label) rows.push({ label: level.label, ink: "grey", kind: "level", series: [], read: () => significant(level.y, 4), shown: true });
  return rows;
}

function csvOf(figure: Figure): string {
  const cell = (text: string): string => (/[",\n]/.test(text) ? `"${text.replaceAll('"', '""')}"` : text);
  const lines = ["series,x,y,lower,upper"];
  const all = (label: string, x: (number | null)[], columns: ((number | null)[] | undefined)[]): void =>
    x.forEach((value, k) => lines.push([cell(label), value ?? "", ...columns.map((column) => column?.[k] ?? "")].join(",")));
  for (const curve of figure.curves) all(curve.label, curve.x, [curve.y, undefined, undefined]);
  for (const band of figure.bands) all(band.label, band.x, [undefined, band.lower, band.upper]);
  return `# ${figure.title}; x: ${figure.x.label}; y: ${figure.y.label}\n${lines.join("\n")}\n`;
}

/// The same figure as the report has it. It is cut out as text: a document that is parsed here would
/// come under this page's policy, which lets no other style in.
export async function saveSvg(report: string, index: number, name: string): Promise<void> {
  const text = await (await blob(report)).text();
  const found = text.match(/<svg class="pm-figure"[\s\S]*?<\/svg>/g)?.[index];
  const style = /<style>([\s\S]*?)<\/style>/.exec(text)?.[1] ?? "";
  if (found) save(`${name}.svg`, new Blob([found.replace(">", `>\n<style>${style}</style>`)], { type: "image/svg+xml" }));
}

function savePng(plot: uPlot, name: string): void {
  const source = plot.ctx.canvas;
  const copy = h("canvas", { width: source.width, height: source.height });
  const context = copy.getContext("2d");
  if (!context) return;
  context.fillStyle = colour("paper");
  context.fillRect(0, 0, copy.width, copy.height);
  context.drawImage(source, 0, 0);
  copy.toBlob((made) => made && save(`${name}.png`, made));
}

export function fileName(title: string): string {
  return title.toLowerCase().replace(/[^a-z0-9]+/g, "-").replace(/^-|-$/g, "") || "plot";
}

// A map has no axes to zoom: its curves as they are.
function drawMap(figure: Figure): Drawn {
  const canvas = h("canvas", { role: "img", "aria-label": `${figure.title}. ${figure.description}` });
  const draw = (): void => {
    const width = canvas.clientWidth;
    const height = Math.min(420, Math.max(200, figure.height));
    canvas.height = height * devicePixelRatio;
    canvas.width = width * devicePixelRatio;
    const context = canvas.getContext("2d");
    if (!context || width === 0) return;
    context.scale(devicePixelRatio, devicePixelRatio);
    const xs = figure.curves.flatMap((curve) => curve.x).filter((x): x is number => x !== null);
    const ys = figure.curves.flatMap((curve) => curve.y ?? []).filter((y): y is number => y !== null);
    const box = { x0: figure.x.min ?? Math.min(...xs), x1: figure.x.max ?? Math.max(...xs), y0: figure.y.min ?? Math.min(...ys), y1: figure.y.max ?? Math.max(...ys) };
    const px = (x: number): number => ((x - box.x0) / (box.x1 - box.x0 || 1)) * width;
    const py = (y: number): number => height - ((y - box.y0) / (box.y1 - box.y0 || 1)) * height;
    for (const curve of figure.curves) {
      context.strokeStyle = context.fillStyle = strokeOf(curve.ink);
      context.lineWidth = curve.mark === "thin" ? 0.7 : 1.5;
      context.setLineDash(dash(curve.mark));
      context.beginPath();
      let down = false;
      curve.x.forEach((x, k) => {
        const y = curve.y?.[k];
        if (x === null || y === null || y === undefined) down = false;
        else if (curve.mark === "points") context.fillRect(px(x) - 2.5, py(y) - 2.5, 5, 5);
        else if (down) context.lineTo(px(x), py(y));
        else {
          context.moveTo(px(x), py(y));
          down = true;
        }
      });
      context.stroke();
    }
    context.font = `11px ${colour("sans")}`;
    for (const one of figure.callouts) {
      if (one.x === null || one.y === null) continue;
      context.fillStyle = strokeOf(one.ink);
      context.textAlign = one.bare ? "center" : "left";
      context.fillText(one.text, px(one.x) + (one.bare ? 0 : 6), py(one.y) + (one.below ? 14 : 4));
    }
  };
  canvas.style.width = "100%";
  const watch = new ResizeObserver(draw);
  watch.observe(canvas);
  return { element: h("div", { class: "chart" }, canvas), dispose: () => watch.disconnect() };
}

export function draw(figure: Figure, options: PlotOptions = {}): Drawn {
  if (isMap(figure)) return drawMap(figure);
  const { data, lines, bands } = aligned(figure);
  const rows = rowsOf(figure, data, lines, bands);
  const logX = figure.x.scale === "log";
  const logY = figure.y.scale === "log";
  const place = h("div", { class: "chart", tabindex: "0", role: "group", "aria-label": `${figure.title}. ${figure.description} Left and right arrows move the readout.` });
  const at = h("th", { class: "num", scope: "col" });
  const cells = rows.map(() => h("td"));
  let index = restingIndex(data, logY);
  const read = (to: number): void => {
    index = to;
    at.textContent = `at ${significant(data[0][to], 4)}`;
    rows.forEach((row, k) => ((cells[k] as HTMLElement).textContent = row.read(to)));
  };
  const height = (): number => options.height ?? Math.round(figure.height * (place.clientWidth < 500 ? 0.9 : 1.1));
  const plot = new uPlot(
    {
      width: 280, // until it is laid out: narrower than any screen
      height: 210,
      legend: { show: false },
      cursor: { drag: { x: true, y: false, uni: 20 }, points: { size: 7 } },
      scales: {
        x: { time: false, distr: logX ? 3 : 1, log: 10, range: range(figure, "x") },
        y: { distr: logY ? 3 : 1, log: 10, range: range(figure, "y") },
      },
      axes: [axis(figure.x.label, logX, 2), axis(figure.y.label, logY, 3)],
      series: [{}, ...lines.map(seriesOf), ...bands.flatMap(() => [edge(), edge()])],
      bands: bands.map((band, k) => ({ series: [lines.length + 2 + 2 * k, lines.length + 1 + 2 * k], fill: withAlpha(strokeOf(band.ink), 0.19) })),
      hooks: {
        draw: [(drawn) => drawExtras(drawn, figure)],
        setCursor: [(drawn) => read(drawn.cursor.idx ?? restingIndex(data, logY))],
      },
    },
    data,
    place,
  );
  place.prepend(h("div", { class: "y-label" }, figure.y.label));
  const legend = h(
    "table",
    { class: "legend" },
    h("thead", {}, h("tr", {}, h("th", { scope: "col" }, "Curve"), at)),
    h(
      "tbody",
      {},
      ...rows.map((row, k) => {
        const toggle = h("button", { type: "button", "aria-pressed": "true", class: `ink-${row.ink}` }, h("span", { class: `sw ${row.kind}` }), ` ${row.label}`);
        toggle.addEventListener("click", () => {
          row.shown = !row.shown;
          toggle.setAttribute("aria-pressed", String(row.shown));
          for (const series of row.series) plot.setSeries(series, { show: row.shown });
        });
        return h("tr", {}, h("td", {}, toggle), cells[k] as HTMLElement);
      }),
    ),
  );
  place.addEventListener("keydown", (event) => {
    const last = data[0].length - 1;
    const to = { ArrowLeft: index - 1, ArrowRight: index + 1, Home: 0, End: last }[event.key];
    if (to === undefined) return;
    event.preventDefault();
    event.stopPropagation();
    const next = Math.min(last, Math.max(0, to));
    plot.setCursor({ left: plot.valToPos(data[0][next] as number, "x"), top: 10 });
    read(next);
  });
  const resize = (): void => {
    if (place.clientWidth > 0) plot.setSize({ width: place.clientWidth, height: height() });
  };
  const watch = new ResizeObserver(resize);
  watch.observe(place);
  if (data[0].length > 0) read(index);
  const element = h("div", { class: options.below ? "plot below" : "plot" }, place, rows.length > 0 && legend);
  const name = fileName(figure.title);
  options.actions?.push(
    { name: "PNG", act: () => savePng(plot, name) },
    { name: "CSV", act: () => save(`${name}.csv`, new Blob([csvOf(figure)], { type: "text/csv" })) },
  );
  return {
    element,
    dispose: () => {
      watch.disconnect();
      plot.destroy();
    },
  };
}

function edge(): uPlot.Series {
  return { stroke: "transparent", width: 0, points: { show: false } };
}
