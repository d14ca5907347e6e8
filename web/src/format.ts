// Numbers as a person reads them: U+2212 for minus, thin spaces between thousands.

const minus = (text: string): string => text.replace(/-/g, "\u2212");

export function significant(value: number | null | undefined, digits = 4): string {
  if (value === null || value === undefined || !Number.isFinite(value)) return "–";
  if (value === 0) return "0";
  const size = Math.abs(value);
  if (size >= 1e7 || size < 1e-4) {
    const [figure, power] = value.toExponential(digits - 1).split("e") as [string, string];
    return minus(`${Number(figure)}e${Number(power)}`);
  }
  const decimals = Math.max(0, digits - 1 - Math.floor(Math.log10(size)));
  return minus(grouped(Number(value.toFixed(Math.min(decimals, 12)))));
}

function grouped(value: number): string {
  const [whole, part] = String(value).split(".") as [string, string | undefined];
  const digits = whole.replace("-", "");
  const text = digits.length > 4 ? digits.replace(/\B(?=(\d{3})+$)/g, "\u202f") : digits;
  return (value < 0 ? "-" : "") + text + (part ? "." + part : "");
}

export const count = (value: number): string => grouped(value);

export function fixed(value: number, decimals: number): string {
  return minus(value.toFixed(decimals));
}

export function duration(seconds: number): string {
  if (seconds < 120) return `${significant(seconds, 3)} s`;
  const total = Math.round(seconds);
  const parts: [number, string][] = [
    [Math.floor(total / 86400), "d"],
    [Math.floor(total / 3600) % 24, "h"],
    [Math.floor(total / 60) % 60, "min"],
    [total % 60, "s"],
  ];
  const first = parts.findIndex(([value]) => value > 0);
  return parts
    .slice(first, first + 2)
    .filter(([value]) => value > 0)
    .map(([value, unit]) => `${value} ${unit}`)
    .join(" ");
}

export function bytes(size: number): string {
  const units = ["B", "kB", "MB", "GB", "TB"];
  let index = 0;
  for (; size >= 1000 && index + 1 < units.length; ++index) size /= 1000;
  return `${significant(size, 3)} ${units[index]}`;
}

export function day(secondsSince1970: number): string {
  const then = new Date(secondsSince1970 * 1000);
  const now = new Date();
  const time = then.toTimeString().slice(0, 5);
  if (then.toDateString() === now.toDateString()) return `today ${time}`;
  const date = `${then.getDate()} ${then.toLocaleString("en", { month: "short" })}`;
  return then.getFullYear() === now.getFullYear() ? date : `${date} ${then.getFullYear()}`;
}

/// "±" and units in a figure are softer than its digits.
export function plain(unit: string): string {
  return unit.replace("m/s^2", "m/s²").replace("m/s2", "m/s²");
}

/// Ticks at 1, 2 or 5 times a power of ten.
export function ticks(low: number, high: number, most: number): { values: number[]; decimals: number } {
  const span = high - low;
  if (!(span > 0) || !Number.isFinite(span)) return { values: [], decimals: 0 };
  const rough = span / Math.max(1, most);
  const power = Math.pow(10, Math.floor(Math.log10(rough)));
  const step = [1, 2, 5, 10].map((k) => k * power).find((k) => k >= rough) ?? 10 * power;
  const values: number[] = [];
  for (let k = Math.ceil(low / step); k * step <= high + 1e-9 * span; ++k) values.push(k * step);
  return { values, decimals: Math.max(0, -Math.floor(Math.log10(step) + 1e-9)) };
}
