// The server's interface, as docs/serve.md describes it.

export interface Note {
  severity: "info" | "warning" | "bad";
  text: string;
}
export interface Thumbnail {
  channel: number;
  min: (number | null)[];
  max: (number | null)[];
}
export interface Summary {
  samples: number;
  duration_s: number;
  rate_hz: number | null;
  format: string;
  channels: { name: string; unit: string | null }[];
  gaps: number;
  clipped: number;
  conclusion: string;
  notes: Note[];
  thumbnails: Thumbnail[];
}
export type State = "waiting" | "running" | "done" | "failed" | "cancelled";
export interface Recording {
  name: string;
  bytes: number;
  modified_s: number;
  state: State;
  error: string | null;
  summary: Summary | null;
}
export interface RecordingList {
  recordings: Recording[];
  sensor_files: string[];
  left: number;
}
export interface ChannelAudit {
  name: string;
  unit: string;
  clipped: number;
  limit_low: number | null;
  limit_high: number | null;
}
export interface Details extends Recording {
  json: { channels: ChannelAudit[]; timing: { source: string; jitter_s: number | null; gaps: { start_s: number; duration_s: number }[] } } | null;
  page: Page | null;
}
export interface ViewHead {
  samples: number;
  end_s: number;
  rate_hz?: number;
  has_stamps?: boolean;
  channels: { name: string; unit: string; quantity?: string; to_si?: number }[];
  rests?: [number, number][];
  why_no_rests?: string;
  knocks_s?: number[];
}
export interface ViewState {
  state: State;
  fraction: number;
  stage: string;
  error: string | null;
  head: ViewHead | null;
}
export interface Window {
  samples: boolean;
  t: number[];
  min: (number | null)[][];
  max: (number | null)[][];
}
export interface Figures {
  channels: { count: number; mean: number; rms: number; std: number; min: number; max: number }[];
}
export interface Axis {
  label: string;
  scale: "linear" | "log" | "bare";
  min: number | null;
  max: number | null;
}
export interface Curve {
  label: string;
  ink: string;
  mark: "line" | "dashes" | "thin" | "points" | "ticks";
  x: (number | null)[];
  y?: (number | null)[];
}
export interface Band {
  label: string;
  ink: string;
  x: (number | null)[];
  lower: (number | null)[];
  upper: (number | null)[];
}
export interface Callout {
  text: string;
  x: number | null;
  y: number | null;
  ink: string;
  below: boolean;
  left: boolean;
  bare: boolean;
}
export interface Figure {
  title: string;
  description: string;
  x: Axis;
  y: Axis;
  height: number;
  bands: Band[];
  curves: Curve[];
  levels: { label: string; y: number | null }[];
  callouts: Callout[];
}
export interface Table {
  caption: string;
  head: string[];
  rows: string[][];
  rows_in_all: number;
}
export interface Section {
  heading: string;
  paragraphs: string[];
  points: string[];
  sides: { label: string; text: string }[];
  tables: Table[];
  figures: Figure[];
  parts: Section[];
}
export interface Page {
  verb: string;
  title: string;
  inputs: string[];
  conclusion: string;
  key_figures: { label: string; value: string }[];
  notes: Note[];
  sections: Section[];
}
export interface Option {
  name: string;
  group: string;
  help: string;
  type: string;
  choices: string[];
  default: string;
  switch: boolean;
  many: boolean;
  file: boolean;
  required: boolean;
}
export interface Verb {
  name: string;
  group: string;
  help: string;
  reads: "recordings" | "sensor_files";
  many_files: boolean;
  page: boolean;
  series: boolean;
  sensor_file: boolean;
  options: Option[];
}
export type OptionValue = string | boolean | string[];
export interface Asked {
  verb: string;
  files: string[];
  options: { [name: string]: OptionValue };
  sensor_file?: boolean;
}
export interface Analysis extends Asked {
  id: number;
  command: string;
  state: State;
  fraction: number;
  stage: string;
  seconds: number;
  messages: string[];
  error: string | null;
  files_made: string[];
}
export interface Info {
  version: string;
  folder: string;
  only: string;
  source: number | null;
}

export class ApiError extends Error {
  constructor(
    readonly status: number,
    message: string,
  ) {
    super(message);
  }
}

const key = "proofmass-token";

/// The token comes in the link and stays in this tab's storage; the address does not keep it.
export function takeToken(): void {
  const here = new URL(location.href);
  const token = here.searchParams.get("token");
  if (!token) return;
  sessionStorage.setItem(key, token);
  here.searchParams.delete("token");
  history.replaceState(null, "", here);
}

type Listener = (connected: boolean) => void;
let listener: Listener = () => {};
export function onConnection(hears: Listener): void {
  listener = hears;
}

export const token = (): string => sessionStorage.getItem(key) ?? "";

async function ask(method: string, path: string, body?: BodyInit, signal?: AbortSignal): Promise<globalThis.Response> {
  const headers = { Authorization: `Bearer ${token()}` };
  let answer: globalThis.Response;
  try {
    answer = await fetch(path, { method, headers, body: body ?? null, signal: signal ?? null, cache: "no-store" });
  } catch (problem) {
    if (!signal?.aborted) listener(false);
    throw problem;
  }
  listener(true);
  if (answer.ok) return answer;
  const text = await answer.text();
  let message = text;
  try {
    message = (JSON.parse(text) as { error: string }).error;
  } catch {
    message = `the server answered ${answer.status}`;
  }
  throw new ApiError(answer.status, message);
}

export async function get<T>(path: string, query: { [name: string]: string | number } = {}, signal?: AbortSignal): Promise<T> {
  const words = Object.entries(query).map(([name, value]) => `${name}=${encodeURIComponent(value)}`);
  const answer = await ask("GET", words.length > 0 ? `${path}?${words.join("&")}` : path, undefined, signal);
  return (await answer.json()) as T;
}

export const blob = async (path: string): Promise<Blob> => (await ask("GET", path)).blob();

export async function begin(asked: Asked): Promise<number> {
  const answer = await ask("POST", "/api/analyses", JSON.stringify(asked));
  return ((await answer.json()) as { id: number }).id;
}

export async function post<T>(path: string, body: unknown): Promise<T> {
  return (await (await ask("POST", path, JSON.stringify(body))).json()) as T;
}
export const remove = async (path: string): Promise<void> => void (await ask("DELETE", path));

export const cancel = async (id: number): Promise<void> => void (await ask("DELETE", `/api/analyses/${id}`));

export async function upload(file: File): Promise<string> {
  const answer = await ask("PUT", `/api/files/${encodeURIComponent(file.name)}`, file);
  return ((await answer.json()) as { name: string }).name;
}

let verbs: Promise<Verb[]> | undefined;
export function allVerbs(): Promise<Verb[]> {
  verbs ??= get<{ verbs: Verb[] }>("/api/verbs").then((table) => table.verbs);
  return verbs;
}

export const listRecordings = (): Promise<RecordingList> => get<RecordingList>("/api/recordings");
export const listAnalyses = async (): Promise<Analysis[]> => (await get<{ analyses: Analysis[] }>("/api/analyses")).analyses;

export const pause = (ms: number): Promise<void> => new Promise((done) => setTimeout(done, ms));
