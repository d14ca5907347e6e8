// Live sources: their lights, strips of the last seconds, the estimate and the noise of one of them.
import { get, pause, post, remove, type Page } from "./api";
import { note, params } from "./address";
import { h, light, replace } from "./dom";
import { bytes, duration, fixed, significant } from "./format";
import { channelInk } from "./inks";
import { Feed, listSources, type Frame, type Head, type LiveChannel, type LiveEvent, type Source } from "./live_api";
import { estimatePanel, type EstimatePanel } from "./live_estimate";
import { startForm } from "./live_start";
import { liveStrips, type LiveStrips } from "./live_strips";
import { sourcesTable } from "./live_table";
import { mergedFigure } from "./merge";
import { notesList } from "./notes";
import { draw as drawPlot, type Drawn } from "./plot";
import { Ring } from "./ring";
import type { View } from "./view";

const windows: [number, string][] = [
  [2, "2 s"],
  [12, "12 s"],
  [60, "1 min"],
  [600, "10 min"],
];

// What is known of the source that is shown.
interface Shown {
  id: number;
  feed: Feed;
  head: Head | undefined;
  ring: Ring | undefined;
  strips: LiveStrips | undefined;
  estimate: EstimatePanel | undefined;
  noise: Map<number, { seconds: number; page: Page }>;
  events: LiveEvent[];
  gaps: number[];
  since: number; ///< begin of the connection, ms: what arrived before is the past
  fresh: number[]; ///< arrival of samples that are not drawn yet, ms
  behind: number[]; ///< delays of the last pictures, ms
}

export function liveView(main: HTMLElement): View {
  let ended = false;
  let sources: Source[] = [];
  let shown: Shown | undefined;
  let seconds = Number(params()["window"] ?? 12) || 12;
  let isSpectrum = params()["plot"] === "spectrum";
  let heldAt: number | undefined;
  let noiseChannel: number | undefined;
  let plot: Drawn | undefined;

  // ---- the frame
  const facts = h("span", { class: "soft facts" });
  const disk = h("span", { class: "soft" });
  const spoken = h("span", { class: "only-heard", role: "status" });
  const form = h("div", {});
  const table = h("div", { class: "panel wide sources-box", tabindex: "0", role: "region", "aria-label": "Sources" });
  const said = h("div", { role: "alert" });
  const stack = h("div", { class: "pb" });
  const title = h("h2", {});
  const unit = h("span", { class: "soft" });
  const spans = h("span", { class: "seg", role: "group", "aria-label": "Window" });
  const kinds = h("span", { class: "seg", role: "group", "aria-label": "Plot" });
  const holdButton = h("button", { type: "button", class: "btn small", "aria-pressed": "false", onclick: () => hold(), title: "The recording goes on" });
  const left = h("section", { class: "panel", "aria-label": "Samples" }, h("div", { class: "ph" }, title, unit, h("span", { class: "r" }, spans, kinds, holdButton)), stack);
  const estimateAt = h("div", {});
  const noiseAt = h("div", { class: "pb side" });
  const noiseChannels = h("span", { class: "seg", role: "group", "aria-label": "Channel" });
  const noisePanel = h("section", { class: "panel", "aria-label": "Noise" }, h("div", { class: "ph" }, h("h2", {}, "Noise"), h("span", { class: "r" }, noiseChannels)), noiseAt);
  const eventsAt = h("div", { class: "pb" });
  const eventsPanel = h("section", { class: "panel", "aria-label": "Events" }, h("div", { class: "ph" }, h("h2", {}, "Events")), eventsAt);
  const grid = h("div", { class: "live", hidden: true }, left, h("div", {}, estimateAt, noisePanel, eventsPanel));
  const add = h("button", { type: "button", class: "btn", "aria-expanded": "false", onclick: () => openForm(form.childElementCount === 0) }, "Add source…");
  replace(main, h("div", { class: "head" }, h("h1", {}, "Live"), facts, h("div", { class: "acts" }, disk, add)), spoken, form, said, table, grid);

  function openForm(open: boolean): void {
    add.setAttribute("aria-expanded", String(open));
    replace(form, open && startForm({ started: (id) => { openForm(false); void choose(id); } }));
  }
  function fail(problem: unknown): void {
    replace(said, h("p", { class: "failure" }, problem instanceof Error ? problem.message : String(problem)));
  }

  // ---- what is shown of the chosen source
  function segments(): void {
    replace(spans, ...windows.map(([value, word]) => h("button", { type: "button", "aria-pressed": String(value === seconds), onclick: () => { seconds = value; note({ window: String(value) }); segments(); } }, word)));
    replace(kinds, ...(["Time", "Spectrum"] as const).map((word) => h("button", { type: "button", "aria-pressed": String((word === "Spectrum") === isSpectrum), onclick: () => { isSpectrum = word === "Spectrum"; note({ plot: isSpectrum ? "spectrum" : "" }); segments(); layOut(); } }, word)));
    replace(holdButton, heldAt === undefined ? "❙❙ Hold " : "▶ Go on ", h("kbd", { class: "keys" }, "space"));
    holdButton.setAttribute("aria-pressed", String(heldAt !== undefined));
  }
  function hold(): void {
    heldAt = heldAt === undefined ? (shown?.ring?.last ?? 0) : undefined;
    segments();
  }

  async function choose(id: number): Promise<void> {
    shown?.feed.close();
    heldAt = undefined;
    noiseChannel = undefined;
    replace(estimateAt);
    replace(stack);
    replace(said);
    note({ source: String(id) });
    const made: Shown = {
      id,
      feed: new Feed(id, (frame) => made === shown && take(made, frame), (is) => !is && replace(facts, light("bad", "the connection is gone; a recording does not depend on this page"))),
      head: undefined, ring: undefined, strips: undefined, estimate: undefined,
      noise: new Map(), events: [], gaps: [], since: Date.now(), fresh: [], behind: [],
    };
    shown = made;
    segments();
    drawNoise();
    drawEvents();
    await refresh();
  }

  function layOut(): void {
    const head = shown?.head;
    if (!shown || !head) return;
    title.textContent = head.source;
    unit.textContent = "min and max of each column";
    shown.strips = undefined;
    if (isSpectrum) return drawNoise();
    shown.strips = liveStrips(head);
    replace(stack, shown.strips.element);
  }

  function begin(one: Shown, head: Head): void {
    // After a new connection all that is kept comes again.
    one.head = head;
    one.events = [];
    one.gaps = [];
    one.since = Date.now();
    one.ring = new Ring(head.channels.length);
    layOut();
    segments();
  }
  function beginEstimate(one: Shown, columns: LiveChannel[]): void {
    const source = sources.find((listed) => listed.id === one.id);
    const what = String(source?.options["estimate"] ?? "") || (columns[0]?.name === "angle" ? "wheel" : columns[0]?.name === "position" ? "track" : "tilt");
    one.estimate = estimatePanel(columns, what);
    replace(estimateAt, one.estimate.element);
  }

  function take(one: Shown, frame: Frame): void {
    if (frame.head) begin(one, frame.head);
    if (frame.columns) beginEstimate(one, frame.columns);
    if (frame.estimates) one.estimate?.add(frame.estimates.t, frame.estimates.values);
    if (frame.rows && one.ring) {
      const { t, min, max } = frame.rows;
      const high = max ?? min;
      t.forEach((time, k) => one.ring?.add(time, (c) => min[c]?.[k] ?? NaN, (c) => high[c]?.[k] ?? NaN));
      if (frame.rows.arrived_ms >= one.since && !document.hidden) one.fresh.push(frame.rows.arrived_ms);
    }
    if (frame.noise) {
      one.noise.set(frame.noise.channel, frame.noise);
      noiseChannel ??= frame.noise.channel;
      if (frame.noise.channel === noiseChannel && heldAt === undefined) drawNoise();
      else noiseTabs();
    }
    if (frame.event) {
      one.events.push(frame.event);
      if (one.events.length > 50) one.events.shift();
      if (["lost", "overrun", "gap"].includes(frame.event.kind)) one.gaps.push(frame.event.start_s);
      drawEvents();
    }
    if (frame.end) void refresh();
  }

  // ---- noise
  function noiseTabs(): void {
    const known = [...(shown?.noise.keys() ?? [])].sort((a, b) => a - b);
    replace(noiseChannels, ...known.map((channel) => h("button", { type: "button", "aria-pressed": String(channel === noiseChannel), onclick: () => { noiseChannel = channel; drawNoise(); } }, shown?.head?.channels[channel]?.name ?? String(channel))));
  }
  function drawNoise(): void {
    noiseTabs();
    const found = noiseChannel === undefined ? undefined : shown?.noise.get(noiseChannel);
    plot?.dispose();
    plot = undefined;
    if (!found || noiseChannel === undefined) return replace(noiseAt, h("p", { class: "soft" }, "The first seconds are being collected."));
    const name = shown?.head?.channels[noiseChannel]?.name ?? "";
    const results = [{ page: found.page, name, ink: channelInk(name, noiseChannel) }];
    const deviation = mergedFigure(results, /deviation/i);
    const spectrum = mergedFigure(results, /spectr/i);
    const shownFigure = isSpectrum ? undefined : deviation;
    if (shownFigure) plot = drawPlot({ ...shownFigure, height: 180 }, { height: 190, below: true });
    if (isSpectrum && spectrum) {
      plot = drawPlot({ ...spectrum, height: 360 }, { height: innerWidth <= 700 ? 240 : 420, below: true });
      replace(stack, h("h3", {}, `${name}: ${spectrum.title}`), plot.element);
    }
    replace(
      noiseAt,
      h("p", { class: "soft" }, `${name}, all ${duration(found.seconds)} since the last gap; meant for a sensor at rest`),
      shownFigure && plot && h("div", {}, h("h3", {}, shownFigure.title), plot.element),
      h("table", {}, h("tbody", {}, ...found.page.key_figures.map((one) => h("tr", {}, h("th", { scope: "row" }, one.label), h("td", { class: "num" }, one.value))))),
      notesList(found.page.notes.filter((one) => one.severity !== "info"), 2),
    );
  }

  // ---- events
  function drawEvents(): void {
    const events = shown?.events ?? [];
    const end = sources.find((one) => one.id === shown?.id)?.last_end;
    eventsPanel.hidden = events.length === 0 && !end;
    const words = events.map((one) => ({ severity: one.severity, text: `${fixed(one.start_s, 2)} s: ${one.text}` })).reverse();
    replace(eventsAt, notesList([...(end?.reason ? [{ severity: "bad" as const, text: end.reason }] : []), ...(end?.audit ?? []), ...words], 4));
  }

  // ---- the picture
  function words(one: Shown): void {
    const now = Date.now();
    for (const arrived of one.fresh) one.behind.push(now - arrived);
    one.fresh.length = 0;
    while (one.behind.length > 500) one.behind.shift();
    const sorted = [...one.behind].sort((a, b) => a - b);
    const running = sources.filter((source) => source.state === "running").length;
    const recording = sources.filter((source) => source.state === "running" && source.file).length;
    const delay = sorted.length > 0 ? `; the picture is ${sorted[sorted.length >> 1]} ms behind the samples (95 %: ${sorted[Math.floor(0.95 * (sorted.length - 1))]} ms)` : "";
    facts.textContent = `${running} ${running === 1 ? "source" : "sources"}, ${recording} recording${delay}`;
  }
  let drawnAt = 0;
  const slow = matchMedia("(prefers-reduced-motion: reduce)");
  function picture(now: number): void {
    if (ended) return;
    requestAnimationFrame(picture);
    const one = shown;
    if (!one || (slow.matches && now - drawnAt < 500)) return;
    // A source that has nothing new costs nothing.
    if (one.fresh.length === 0 && now - drawnAt < 250) return;
    drawnAt = now;
    if (one.ring && one.strips) one.strips.draw(one.ring, heldAt ?? one.ring.last, seconds, one.gaps);
    if (heldAt === undefined) one.estimate?.draw();
    words(one);
  }

  // ---- the list
  async function stopAndWait(source: Source): Promise<void> {
    await remove(`/api/live/${source.id}`);
    for (;;) {
      const now = await get<Source>(`/api/live/${source.id}`);
      if (now.state === "ended" || now.state === "failed") return;
      await pause(100);
    }
  }
  const actions = {
    choose: (id: number) => void choose(id),
    stop: (source: Source) => void remove(`/api/live/${source.id}`).then(refresh, fail),
    forget: (source: Source) => void remove(`/api/live/${source.id}`).then(refresh, fail),
    // The device is opened anew, by a recorder with a file.
    record: async (source: Source): Promise<void> => {
      try {
        await stopAndWait(source);
        const made = await post<{ id: number }>("/api/live", { source: source.source, file: "", options: source.options });
        await remove(`/api/live/${source.id}`);
        await choose(made.id);
      } catch (problem) {
        fail(problem);
      }
    },
  };
  let drawnTable = "";
  async function refresh(): Promise<void> {
    const now = await listSources();
    if (ended) return;
    sources = now.sources.filter((one) => one.options["procedure"] === undefined);
    disk.textContent = now.free_bytes === null ? "" : `disk ${bytes(now.free_bytes)} free`;
    const text = JSON.stringify([sources, shown?.id, shown?.feed.leftOut]);
    if (text !== drawnTable) {
      drawnTable = text;
      const focus = document.activeElement?.closest("tr")?.dataset["source"];
      sourcesTable(table, sources, shown?.id, shown?.feed.leftOut ?? 0, actions);
      if (focus) table.querySelector<HTMLElement>(`tr[data-source="${focus}"] button`)?.focus();
    }
    table.hidden = sources.length === 0;
    grid.hidden = !shown || !sources.some((one) => one.id === shown?.id);
    if (shown) drawEvents();
  }
  function speak(): void {
    const source = sources.find((one) => one.id === shown?.id);
    if (source?.last_state) spoken.textContent = `${source.source}: ${significant(source.last_state.time_s, 4)} seconds, lost ${source.last_state.lost}, gaps ${source.last_state.gaps}`;
  }
  async function watch(): Promise<void> {
    await refresh();
    const asked = Number(params()["source"]);
    const first = sources.find((one) => one.id === asked) ?? sources.find((one) => one.state === "running") ?? sources.at(-1);
    if (first) void choose(first.id);
    else openForm(true);
    for (let round = 1; !ended; ++round) {
      await pause(1000);
      await refresh().catch(() => undefined);
      if (round % 5 === 0) speak();
    }
  }
  segments();
  watch().catch(fail);
  requestAnimationFrame(picture);
  const relay = new ResizeObserver(() => (drawnAt = 0));
  relay.observe(left);

  return {
    dispose: () => {
      ended = true;
      shown?.feed.close();
      plot?.dispose();
      relay.disconnect();
    },
    key: (key) => {
      const at = sources.findIndex((one) => one.id === shown?.id);
      const next = sources[at + (key === "ArrowDown" ? 1 : -1)];
      if (key === " ") hold();
      else if (key === "a") openForm(form.childElementCount === 0);
      else if (key === "w") spans.querySelector<HTMLButtonElement>("button[aria-pressed=true] + button, button:first-child")?.click();
      else if (key === "r" && sources[at]?.state === "running" && !sources[at]?.file) void actions.record(sources[at] as Source);
      else if ((key === "ArrowDown" || key === "ArrowUp") && next) void choose(next.id);
      else if (key === "Escape" && form.childElementCount > 0) openForm(false);
      else return false;
      return true;
    },
  };
}
