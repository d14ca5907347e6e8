// The main curve of the same figure of several results, in one plot.
import type { Curve, Figure, Page, Section } from "./api";

export interface Named {
  page: Page;
  name: string;
  ink: string;
}

export function figuresOf(page: Page): Figure[] {
  const of = (section: Section): Figure[] => [...section.figures, ...section.parts.flatMap(of)];
  return page.sections.flatMap(of);
}

// "Deviation (mg)" as what is measured, and how many g its unit is.
function unitOf(label: string): { quantity: string; factor: number } {
  const found = /^(.*)\(([nµm]?)(g\b.*)\)$/.exec(label);
  if (!found) return { quantity: label, factor: 1 };
  const factors: { [prefix: string]: number } = { n: 1e-9, µ: 1e-6, m: 1e-3 };
  return { quantity: `${found[1]} ${found[3]}`, factor: factors[found[2] ?? ""] ?? 1 };
}

const scaled = (values: (number | null)[] | undefined, by: number): (number | null)[] => (values ?? []).map((value) => (value === null ? null : value * by));

const mainCurve = (figure: Figure): Curve | undefined => figure.curves.find((curve) => /measured|deviation|spectrum/i.test(curve.label) && !/fitted/i.test(curve.label)) ?? figure.curves[0];

/// The figure whose title fits, of the first result, with each result's main curve and first band,
/// in the unit of the first; none where no result has one.
export function mergedFigure(results: Named[], title: RegExp): Figure | undefined {
  const found = results.flatMap((result) => {
    const figure = figuresOf(result.page).find((one) => title.test(one.title));
    return figure ? [{ ...result, figure }] : [];
  });
  const first = found[0]?.figure;
  if (!first) return undefined;
  const unit = unitOf(first.y.label);
  const alike = found
    .map((one) => ({ ...one, unit: unitOf(one.figure.y.label) }))
    .filter((one) => one.unit.quantity === unit.quantity)
    .map((one) => ({ ...one, by: one.unit.factor / unit.factor }));
  return {
    ...first,
    title: first.title.replace(/^[^:]+: /, "").replace(/^./, (letter) => letter.toUpperCase()),
    y: { ...first.y, min: null, max: null },
    levels: [],
    callouts: [],
    curves: alike.flatMap(({ figure, name, ink, by }) => {
      const curve = mainCurve(figure);
      return curve ? [{ ...curve, y: scaled(curve.y, by), label: name, ink, mark: "line" as const }] : [];
    }),
    bands: alike.flatMap(({ figure, ink, by }) => figure.bands.slice(0, 1).map((band) => ({ ...band, lower: scaled(band.lower, by), upper: scaled(band.upper, by), label: "", ink }))),
  };
}
