// The last samples of a live source, as extremes at three resolutions, so that any window is drawn
// from few columns. Each level holds the extremes of eight buckets of the one before.

const coarser = 8;
const room = 16384; // buckets of a level

interface Level {
  t: Float64Array;
  min: Float32Array[];
  max: Float32Array[];
  count: number; ///< written so far
  pending: number; ///< buckets of the level before in the one that is being filled
}

function level(channels: number): Level {
  const lists = (): Float32Array[] => Array.from({ length: channels }, () => new Float32Array(room));
  return { t: new Float64Array(room), min: lists(), max: lists(), count: 0, pending: 0 };
}

export interface Slice {
  length: number;
  t: (k: number) => number;
  min: (channel: number, k: number) => number;
  max: (channel: number, k: number) => number;
}

export class Ring {
  private readonly levels: Level[];
  last = NaN; ///< time of the last sample

  constructor(private readonly channels: number) {
    this.levels = [level(channels), level(channels), level(channels)];
  }

  add(t: number, min: (channel: number) => number, max: (channel: number) => number): void {
    this.last = t;
    this.levels.forEach((one, depth) => {
      const starts = depth === 0 || one.pending === 0;
      const at = (starts ? one.count++ : one.count - 1) % room;
      if (starts) one.t[at] = t;
      one.pending = depth === 0 ? 0 : (one.pending + 1) % Math.pow(coarser, depth);
      for (let c = 0; c < this.channels; ++c) {
        const low = one.min[c] as Float32Array;
        const high = one.max[c] as Float32Array;
        low[at] = starts ? min(c) : Math.min(low[at] ?? NaN, min(c));
        high[at] = starts ? max(c) : Math.max(high[at] ?? NaN, max(c));
      }
    });
  }

  /// The buckets from a time on, at the finest resolution that holds all of them in few enough.
  since(from: number, most: number): Slice {
    for (const one of this.levels) {
      const held = Math.min(one.count, room);
      const first = one.count - held;
      const oldest = one.t[first % room] ?? NaN;
      let low = first;
      let high = one.count;
      while (low < high) {
        const middle = (low + high) >> 1;
        if ((one.t[middle % room] ?? 0) < from) low = middle + 1;
        else high = middle;
      }
      const length = one.count - low;
      const isLast = one === this.levels.at(-1);
      if (!isLast && (length > most || (first > 0 && oldest > from))) continue;
      const place = (k: number): number => (low + k) % room;
      return {
        length,
        t: (k) => one.t[place(k)] ?? NaN,
        min: (channel, k) => one.min[channel]?.[place(k)] ?? NaN,
        max: (channel, k) => one.max[channel]?.[place(k)] ?? NaN,
      };
    }
    return { length: 0, t: () => NaN, min: () => NaN, max: () => NaN };
  }
}
