// Guided calibration: where to lay the sensor next, what is done, and how good it is so far.
import { blob, pause, post, remove } from "./api";
import { link, note, params } from "./address";
import { h, light, replace, save, svg } from "./dom";
import { fixed, plain, significant } from "./format";
import { Feed, listSources, type Figures, type Guide, type Source } from "./live_api";
import { startForm } from "./live_start";
import { draw as drawPlot, type Drawn } from "./plot";
import { progress } from "./recording";
import { orientation } from "./orientation";
import { hemisphere, residualBar, shadeLevels, shading } from "./sphere";
import type { View } from "./view";

const milli = 1000;

function residuals(guide: Guide): HTMLElement {
  const known = guide.poses.filter((pose) => pose.residual_g !== null);
  const most = 1.05 * Math.max(1e-9, ...known.map((pose) => milli * Math.max(Math.abs(pose.residual_g ?? 0), 2 * (pose.residual_std_g ?? 0))));
  const row = (pose: Guide["poses"][number]): HTMLElement =>
    h(
      "tr",
      { class: pose.is_suspect ? "red" : "" },
      h("td", { class: "num" }, String(pose.number)),
      h("th", { scope: "row" }, pose.words || "not known yet"),
      h("td", {}, pose.residual_g === null ? "" : residualBar(milli * pose.residual_g, milli * (pose.residual_std_g ?? 0), most, pose.is_suspect)),
      h("td", { class: "num" }, pose.residual_g === null ? "–" : significant(milli * pose.residual_g, 3)),
    );
  return h(
    "section",
    { class: "panel", "aria-label": "Residuals" },
    h("div", { class: "ph" }, h("h2", {}, "Residuals, by a fit to the others"), h("span", { class: "soft" }, "mg; grey is ± 2 standard deviations of the noise")),
    h("div", { class: "pb" }, h("table", { class: "residuals" }, h("thead", {}, h("tr", {}, h("th", { scope: "col", class: "num" }, "No."), h("th", { scope: "col" }, "Up"), h("th", { scope: "col" }, h("span", { class: "only-heard" }, "Residual, as a bar")), h("th", { scope: "col", class: "num" }, "mg"))), h("tbody", {}, ...guide.poses.map(row)))),
  );
}

function accuracy(guide: Guide): { element: HTMLElement; plot: Drawn | undefined } {
  const points = guide.errors_g.map((error, k) => ({ x: k + 1, y: error === null ? null : milli * error })).filter((one) => one.y !== null);
  const target = milli * guide.target_g;
  const plot =
    points.length > 1
      ? drawPlot(
          {
            title: "Accuracy so far", description: "Largest standard deviation of a calibrated measurement of 1 g after each position.", height: 160,
            x: { label: "Positions", scale: "linear", min: null, max: null },
            y: { label: "mg", scale: "log", min: null, max: null },
            bands: [], callouts: [],
            levels: [{ label: "target", y: target }],
            curves: [{ label: "standard deviation", ink: "blue", mark: "line", x: points.map((one) => one.x), y: points.map((one) => one.y) }],
          },
          { height: 160, below: true },
        )
      : undefined;
  const now = guide.error_g === null ? h("div", { class: "big" }, "–") : h("div", { class: "big" }, significant(milli * guide.error_g, 2), h("small", {}, ` mg, target ${significant(target, 2)} mg`));
  const worst = guide.maps && h("p", {}, `${significant(milli * guide.maps.largest_g, 2)} mg `, h("span", { class: "soft" }, "in the least certain direction"));
  const gain = guide.next_gain !== null && h("p", {}, `${fixed(-100 * guide.next_gain, 0)} % `, h("span", { class: "soft" }, `by position ${guide.poses.length + 1}`));
  const element = h(
    "section",
    { class: "panel", "aria-label": "Accuracy so far" },
    h("div", { class: "ph" }, h("h2", {}, "Accuracy so far"), h("span", { class: "soft" }, "standard deviation of a calibrated measurement at 1 g")),
    h("div", { class: "pb" }, now, worst, gain, guide.error_g === null && h("p", { class: "soft" }, "Nine positions determine bias, scale and angles."), plot?.element),
  );
  return { element, plot };
}

function figures(of: Figures, unit: string): HTMLElement {
  // As many decimals as two digits of the standard deviation have.
  const shown = (value: number | undefined, std: number | undefined): string => {
    if (value === undefined || std === undefined || !(std > 0)) return "–";
    const decimals = Math.max(0, 1 - Math.floor(Math.log10(std)));
    return `${fixed(value, decimals)} ± ${fixed(std, decimals)}`;
  };
  const row = (k: number, axis: string, angle: string): HTMLElement =>
    h(
      "tr",
      {},
      h("th", { scope: "row" }, axis),
      h("td", { class: "num" }, shown(milli * (of.bias_g[k] ?? NaN), milli * (of.bias_std_g[k] ?? NaN))),
      h("td", { class: "num" }, shown(of.scale[k], of.scale_std[k])),
      h("td", { class: "num" }, h("span", { class: "soft" }, `${angle} `), shown(milli * (of.angles_rad[k] ?? NaN), milli * (of.angles_std_rad[k] ?? NaN))),
    );
  return h(
    "section",
    { class: "panel", "aria-label": "Figures so far" },
    h("div", { class: "ph" }, h("h2", {}, "Figures so far"), h("span", { class: "soft" }, "± 1 standard deviation; certificate and sensor file at the end")),
    h(
      "div",
      { class: "pb" },
      h(
        "table",
        { class: "figures" },
        h("thead", {}, h("tr", {}, h("th", { scope: "col" }, "Axis"), h("th", { scope: "col", class: "num" }, "Bias (mg)"), h("th", { scope: "col", class: "num" }, `Output at 1 g, less the bias${unit === "" ? "" : ` (${unit})`}`), h("th", { scope: "col", class: "num" }, "Misalignment (mrad)"))),
        h("tbody", {}, row(0, "x", "yz"), row(1, "y", "zy"), row(2, "z", "zx")),
      ),
    ),
  );
}

export function calibrationView(main: HTMLElement): View {
  let ended = false;
  let source: Source | undefined;
  let feed: Feed | undefined;
  let guide: Guide | undefined;
  let plot: Drawn | undefined;
  let slowly = "";
  let shades: SVGElement[] = [];

  const facts = h("span", { class: "soft facts" });
  const leaveOut = h("button", { type: "button", class: "btn", onclick: () => void answer("skip") }, "Leave it out ", h("kbd", { class: "keys" }, "n"));
  const repeat = h("button", { type: "button", class: "btn", hidden: true, onclick: () => void answer("repeat") }, "Repeat what contradicts ", h("kbd", { class: "keys" }, "p"));
  const finish = h("button", { type: "button", class: "btn", onclick: () => void answer("quit") }, "End and calibrate ", h("kbd", { class: "keys" }, "e"));
  const said = h("div", { role: "alert" });
  const instruction = h("div", { class: "say", role: "status" });
  const held = h("div", {});
  const state = h("p", {});
  const spheres = h("div", { class: "spheres" });
  const right = h("div", {});
  const figuresPlace = h("div", {});
  const result = h("div", {});
  const form = h("div", {});
  const legend = h("p", { class: "soft" }, "○ done   ■ contradicts the others   ◎ next best   + the 26 that are offered");
  const shadeLegend = h("span", { class: "soft shades" });
  const drawings = h("div", { class: "orientations" });
  const steps = h("section", { class: "panel", "aria-label": "Instruction" }, h("div", { class: "pb instruction" }, h("div", {}, instruction, held, state), drawings));
  const grid = h(
    "div",
    { class: "calibration", hidden: true },
    h("div", {}, result, steps, h("section", { class: "panel", "aria-label": "Directions" }, h("div", { class: "ph" }, h("h2", {}, "Directions"), h("span", { class: "soft" }, "which way up is in the sensor's axes; equal areas"), shadeLegend), h("div", { class: "pb" }, spheres, legend)), figuresPlace),
    right,
  );
  const again = h("button", { type: "button", class: "btn", onclick: () => openForm() }, "New calibration…");
  replace(main, h("div", { class: "head" }, h("h1", {}, "Calibration"), facts, h("div", { class: "acts" }, leaveOut, repeat, finish, again)), said, form, grid);

  function fail(problem: unknown): void {
    replace(said, h("p", { class: "failure" }, problem instanceof Error ? problem.message : String(problem)));
  }
  function openForm(): void {
    replace(form, form.childElementCount === 0 && startForm({ procedure: true, started: (id) => { replace(form); void choose(id); } }));
  }
  async function answer(word: string): Promise<void> {
    if (!source) return;
    try {
      await post(`/api/live/${source.id}/${word}`, {});
    } catch (problem) {
      fail(problem);
    }
  }
  async function choose(id: number): Promise<void> {
    feed?.close();
    guide = undefined;
    slowly = "";
    note({ source: String(id) });
    replace(said);
    feed = new Feed(id, (frame) => { if (frame.guide) draw(frame.guide); if (frame.end) void refresh(); }, () => undefined);
    await refresh(id);
  }

  function draw(now: Guide): void {
    guide = now;
    grid.hidden = false;
    steps.hidden = source?.state === "ended" || source?.state === "failed";
    const words = now.is_done ? "All positions are taken." : now.prompt;
    if (instruction.textContent !== words) instruction.textContent = words;
    replace(held, now.hold_fraction !== null && progress(now.hold_fraction));
    replace(state, light(now.phase === "resting" ? "good" : now.phase === "stuck" ? "bad" : "none", now.live), now.said && h("span", { class: "soft" }, `  ${now.said}`));
    replace(drawings, orientation(now.now, "now", false), !now.is_done && orientation(now.next, "wanted", true));
    repeat.hidden = !now.can_repeat || steps.hidden;
    // What only a new position changes.
    const text = JSON.stringify([now.poses, now.errors_g]);
    const isNew = text !== slowly;
    slowly = text;
    if (isNew) {
      shades = now.maps ? [shading(now.maps, false), shading(now.maps, true)] : [];
      const levels = now.maps ? shadeLevels(now.maps) : [];
      replace(shadeLegend, ...(now.maps ? [`std ${significant(milli * (levels[0] ?? 0), 2)} `, svg("svg", { viewBox: "0 0 80 12", class: "swatches", "aria-hidden": "true" }, ...levels.map((_, k) => svg("g", {}, ...levels.slice(0, k).map(() => svg("rect", { x: 16 * k, y: 0, width: 14, height: 12, class: "shade" })), svg("rect", { x: 16 * k + 0.5, y: 0.5, width: 13, height: 11, class: "edge" })))), ` ${significant(milli * now.maps.largest_g, 2)} mg`] : []));
    }
    replace(spheres, h("figure", {}, h("figcaption", {}, "+z up half"), hemisphere(now, false, shades[0])), h("figure", {}, h("figcaption", {}, "−z up half"), hemisphere(now, true, shades[1])));
    if (!isNew) return;
    replace(figuresPlace, now.figures && figures(now.figures, plain(source?.last_head?.channels[0]?.unit ?? "")));
    plot?.dispose();
    const drawn = accuracy(now);
    plot = drawn.plot;
    replace(right, drawn.element, now.poses.length > 0 && residuals(now));
  }

  function results(one: Source): void {
    const isOver = one.state === "ended" || one.state === "failed";
    steps.hidden = !guide || isOver;
    leaveOut.hidden = finish.hidden = isOver;
    repeat.hidden = isOver || !guide?.can_repeat;
    again.hidden = !isOver;
    if (!isOver) return replace(result, one.state === "ending" || guide?.is_done ? h("p", { class: "soft" }, "being calibrated…") : false);
    const download = (name: string | null, word: string): HTMLElement | false => name !== null && h("button", { type: "button", class: "btn", onclick: () => void blob(`/api/files/${encodeURIComponent(name)}`).then((made) => save(name, made), fail) }, `${word} `, h("span", { class: "soft" }, name));
    replace(
      result,
      h(
        "section",
        { class: "panel", "aria-label": "Result" },
        h("div", { class: "ph" }, h("h2", {}, one.state === "failed" ? "It failed" : one.sensor_file ? "Calibrated" : "Ended without a calibration")),
        h("div", { class: "pb" }, one.error && h("p", { class: "failure" }, one.error), h("p", { class: "bar" }, download(one.certificate, "Certificate"), download(one.sensor_file, "Sensor file"), one.file && (one.last_end?.files ?? []).includes(one.file) && h("a", { class: "btn", ...link({ v: "recording", file: one.file }) }, "Recording"), h("button", { type: "button", class: "btn", onclick: () => void remove(`/api/live/${one.id}`).then(() => note({ source: "" })) }, "Forget"))),
      ),
    );
  }

  async function refresh(id = source?.id): Promise<void> {
    const { sources } = await listSources();
    if (ended) return;
    source = sources.find((one) => one.id === id);
    if (!source) return;
    grid.hidden = false;
    const count = guide?.poses.length ?? 0;
    facts.textContent = `${source.source}, ${source.options["procedure"] ?? ""}, ${count} ${count === 1 ? "position" : "positions"}${guide ? `, target ${fixed(milli * guide.target_g, 2)} mg` : ""}`;
    results(source);
  }
  async function watch(): Promise<void> {
    const procedures = (await listSources()).sources.filter((one) => one.options["procedure"] !== undefined);
    const asked = procedures.find((one) => one.id === Number(params()["source"])) ?? procedures.find((one) => one.state === "running");
    leaveOut.hidden = finish.hidden = true;
    if (asked) void choose(asked.id);
    else openForm();
    while (!ended) {
      await pause(1000);
      await refresh().catch(() => undefined);
    }
  }
  watch().catch(fail);

  return {
    dispose: () => {
      ended = true;
      feed?.close();
      plot?.dispose();
    },
    key: (key) => {
      if (key === "n") void answer("skip");
      else if (key === "p" && !repeat.hidden) void answer("repeat");
      else if (key === "e") void answer("quit");
      else return false;
      return true;
    },
  };
}
