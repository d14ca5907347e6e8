// Live sources: what the server says of them, and the WebSocket that brings their frames.
import { get, token } from "./api";
import type { Page } from "./api";

export interface LiveChannel {
  name: string;
  unit: string;
  to_si: number;
  is_acceleration: boolean;
}
export interface Head {
  source: string;
  format: string;
  rate_hz: number | null;
  channels: LiveChannel[];
  file: string | null;
}
export interface Rows {
  every: number;
  arrived_ms: number;
  t: number[];
  min: (number | null)[][];
  max?: (number | null)[][];
}
export interface Counts {
  time_s: number;
  samples: number;
  lost: number;
  gaps: number;
  silence_s: number | null;
}
export interface Audit {
  jitter_s: number | null;
  channels: { name: string; clipped: number }[];
}
export interface LiveEvent {
  kind: string;
  severity: "info" | "warning" | "bad";
  start_s: number;
  text: string;
}
export interface End {
  how: string;
  reason: string;
  files: string[];
  samples: number;
  lost: number;
  gaps: number;
  duration_s: number;
  audit: { severity: "info" | "warning" | "bad"; text: string }[];
}
export interface Pose {
  number: number;
  words: string;
  up: [number, number, number];
  residual_g: number | null;
  residual_std_g: number | null;
  is_suspect: boolean;
}
/// Standard deviation of |f| at 1 g on equal-area maps about +z and −z, as docs/serve.md describes.
export interface Maps {
  plus_z_g: number[][];
  minus_z_g: number[][];
  largest_g: number;
}
export interface Figures {
  bias_g: number[];
  bias_std_g: number[];
  scale: number[];
  scale_std: number[];
  angles_rad: number[];
  angles_std_rad: number[];
}
export interface Guide {
  procedure: string;
  prompt: string;
  said: string;
  live: string;
  phase: string;
  hold_fraction: number | null;
  now: [number, number, number] | null;
  next: [number, number, number] | null;
  error_g: number | null;
  target_g: number;
  errors_g: (number | null)[];
  next_gain: number | null;
  figures: Figures | null;
  maps: Maps | null;
  can_repeat: boolean;
  poses: Pose[];
  is_done: boolean;
}
export interface Source {
  id: number;
  source: string;
  file: string | null;
  sensor_file: string | null;
  certificate: string | null;
  options: { [name: string]: string | number };
  state: "opening" | "running" | "ending" | "ended" | "failed";
  error: string | null;
  messages: string[];
  last_head: Head | null;
  last_state: Counts | null;
  last_audit: Audit | null;
  last_guide: Guide | null;
  last_end: End | null;
}
export interface Found {
  found: { uri: string; what: string }[];
  kinds: { grammar: string; what: string }[];
}
export interface Frame {
  head?: Head;
  columns?: LiveChannel[];
  rows?: Rows;
  estimates?: { t: number; values: (number | null)[] };
  state?: Counts;
  audit?: Audit;
  noise?: { channel: number; seconds: number; page: Page };
  event?: LiveEvent;
  guide?: Guide;
  end?: End;
}

export const listSources = (): Promise<{ sources: Source[]; free_bytes: number | null }> => get("/api/live");
export const findSources = (): Promise<Found> => get("/api/live/found");

/// Shows the frames of one source; connects anew where the connection breaks.
export class Feed {
  private socket: WebSocket | undefined;
  private ended = false;
  leftOut = 0;

  constructor(
    private readonly source: number,
    private readonly hear: (frame: Frame) => void,
    private readonly connected: (is: boolean) => void,
  ) {
    this.connect();
  }

  private connect(): void {
    if (this.ended) return;
    const socket = new WebSocket(`ws://${location.host}/api/live/socket?token=${encodeURIComponent(token())}`);
    this.socket = socket;
    socket.onopen = () => {
      this.connected(true);
      socket.send(JSON.stringify({ watch: this.source }));
    };
    socket.onmessage = (message) => {
      const said = JSON.parse(String(message.data)) as { source: number; left_out: number; frame: Frame };
      this.leftOut = said.left_out;
      this.hear(said.frame);
    };
    socket.onclose = () => {
      if (this.ended) return;
      this.connected(false);
      setTimeout(() => this.connect(), 1000);
    };
  }

  close(): void {
    this.ended = true;
    this.socket?.close();
  }
}
