// Drives the page in Chromium, as a person would: every view, in light and dark, on a desk and on a
// phone. Skipped, with a word, where Chromium or the packages of package.json are missing.
import { spawnSync } from "node:child_process";
import { readFileSync, rmSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { after, before, test } from "node:test";
import assert from "node:assert/strict";
import { address, audit, base, folder, newContext, open, patience, program, shot, start, stop } from "./browser.mjs";

// Deterministic noise: sum of twelve uniform numbers of a small generator.
function noise(seed) {
  let state = seed;
  const uniform = () => (state = (state * 48271) % 2147483647) / 2147483647;
  return () => Array.from({ length: 12 }, uniform).reduce((sum, one) => sum + one, -6);
}

before(async () => {
  const made = spawnSync(program, ["simulate", "--output", "rig.csv", "--duration", "20", "--seed", "1"], { cwd: folder });
  assert.equal(made.status, 0, String(made.stderr));
  for (const [name, size, seed] of [["quiet", 0.001, 1], ["loud", 0.004, 2]]) {
    const next = noise(seed);
    const rows = Array.from({ length: 20000 }, (_, k) => `${k / 100},${(size * next()).toFixed(7)}`);
    writeFileSync(join(folder, `${name}.csv`), `t (s),x (g)\n${rows.join("\n")}\n`);
  }
  for (const name of ["quiet", "loud"]) {
    const written = spawnSync(program, ["noise", `${name}.csv`, "--update-sensor", `${name}.toml`], { cwd: folder });
    assert.equal(written.status, 0, String(written.stderr));
  }
  await start();
});
after(stop);

async function run(page, verb, file, options = "") {
  await page.goto(`${base()}/?v=analysis&verb=${verb}&file=${file}${options}`);
  await page.waitForSelector("button[type=submit]:not([disabled])");
  await page.click("button[type=submit]");
  await page.waitForSelector(".conclusion", { timeout: patience });
}

test("without a token the page shows nothing of the folder", async () => {
  const context = await newContext();
  const page = await context.newPage();
  await page.goto(base() + "/");
  await page.waitForSelector("text=needs the link");
  assert.doesNotMatch(await page.content(), /rig\.csv/);
  await context.close();
});

test("the token leaves the address, and a reload keeps the view", async () => {
  const { page, close } = await open("v=recordings&file=quiet.csv");
  assert.doesNotMatch(String(await address(page)), /token/);
  await page.reload();
  await page.waitForSelector('[role=option][aria-selected=true] >> text=quiet.csv');
  await close();
});

test("the list shows what inspect says, and its keys work", async () => {
  const { page, close } = await open();
  await page.waitForFunction(() => document.querySelectorAll(".row canvas").length === 4, null, { timeout: patience });
  const row = page.locator('[role=option]', { hasText: "rig.csv" }).first();
  assert.match(await row.innerText(), /200 Hz[\s\S]*20 s[\s\S]*6/);
  await page.keyboard.press("/");
  await page.keyboard.type("rate<150");
  assert.equal(await page.locator("[role=option]").count(), 2);
  await page.fill("input[type=search]", "");
  await page.keyboard.press("Escape");
  await page.keyboard.press("ArrowDown");
  await shot(page, "recordings-light");
  await page.keyboard.press("Enter");
  await page.waitForSelector(".strip canvas");
  assert.match(String(await address(page)), /v=recording&/);
  await close();
});

test("a recording is zoomed, panned and reset, and a stretch goes to an analysis", async () => {
  const { page, close } = await open("v=recording&file=rig.csv");
  await page.waitForSelector("text=/In view 0.00 – (20|19)/");
  const view = async () => { const at = (await address(page)).searchParams; return [Number(at.get("from")), Number(at.get("to"))]; };
  const canvas = page.locator('canvas[aria-label="acc1_x against time"]');
  await canvas.waitFor();
  await page.waitForSelector(".head >> text=nothing wrong with it");
  await page.waitForSelector(".side .legend");
  const box = await canvas.boundingBox();
  await page.mouse.move(box.x + box.width * 0.4, box.y + 40);
  await page.mouse.down();
  await page.mouse.move(box.x + box.width * 0.6, box.y + 40, { steps: 4 });
  await page.mouse.up();
  await page.waitForFunction(() => location.search.includes("from="), null, { timeout: 8000 });
  const zoomed = await view();
  assert.ok(zoomed[0] > 6 && zoomed[1] < 14 && zoomed[1] - zoomed[0] > 3, String(zoomed));
  await page.mouse.wheel(0, -400);
  await page.waitForFunction((before) => new URLSearchParams(location.search).get("from") > before, zoomed[0]);
  const closer = await view();
  assert.ok(closer[1] - closer[0] < zoomed[1] - zoomed[0], String(closer));
  await page.keyboard.press("ArrowRight");
  const panned = await view();
  assert.ok(panned[0] > closer[0], String(panned));
  await page.keyboard.press("f");
  const fitted = await view();
  assert.ok(fitted[0] === 0 && Math.abs(fitted[1] - 19.995) < 1e-6, String(fitted));
  await page.keyboard.press("Backspace");
  const back = await view();
  assert.ok(Math.abs(back[0] - panned[0]) < 1e-9 && Math.abs(back[1] - panned[1]) < 1e-9, `${back}, not ${panned}`);
  await page.keyboard.press("f");
  // Cursors: mean and rms of a whole number of turns are those of the file.
  await page.goto(`${base()}/?v=recording&file=rig.csv&a=5&b=10&stretch=2,6`);
  await page.waitForSelector("table caption:has-text('Δt 5 s')");
  const rows = readFileSync(join(folder, "rig.csv"), "utf8").split("\n").filter((line) => /^[-\d.]+,/.test(line)).map((line) => line.split(",").map(Number));
  const between = rows.slice(1000, 2001).map((row) => row[1]);
  const mean = between.reduce((sum, value) => sum + value, 0) / between.length;
  const shown = (await page.locator("tbody tr", { hasText: "acc1_x (m/s²)" }).first().locator("td").nth(3).innerText()).replace("−", "-");
  assert.ok(Math.abs(Number(shown) - mean) < 1e-3 * Math.max(1, Math.abs(mean)), `${shown} ${mean}`);
  await page.locator("button.chip", { hasText: "acc1_y" }).click();
  assert.equal(await page.locator('canvas[aria-label="acc1_y against time"]').count(), 0);
  await shot(page, "recording-light");
  await page.click("text=Analyse stretch");
  await page.waitForSelector("#option-from");
  assert.equal(await page.inputValue("#option-from"), "2");
  assert.equal(await page.inputValue("#option-to"), "6");
  await close();
});

test("spectrum and Allan deviation are of what is in view", async () => {
  const { page, close } = await open("v=recording&file=quiet.csv");
  await page.waitForSelector(".side .legend", { timeout: patience });
  const text = await page.locator(".side").innerText();
  assert.match(text, /Spectrum/);
  assert.match(text, /Allan deviation/i);
  await close();
});

test("noise of two recordings, their downloads, and the two compared", async () => {
  const { page, close } = await open();
  await run(page, "noise", "quiet.csv");
  // White noise of 1 mg a sample at 100 Hz is 1 mg / √100 Hz, two-sided.
  const quiet = await page.locator(".conclusion").innerText();
  const density = Number(/White noise ([\d.]+)/.exec(quiet)?.[1]);
  assert.ok(Math.abs(density - 100) < 3, quiet);
  assert.ok((await page.locator(".uplot").count()) >= 2);
  const [download] = await Promise.all([page.waitForEvent("download"), page.click("button:has-text('JSON')")]);
  const result = JSON.parse(readFileSync(await download.path(), "utf8"));
  assert.equal(result.verb, "noise");
  const [svg] = await Promise.all([page.waitForEvent("download"), page.locator("button:has-text('SVG')").first().click()]);
  assert.match(readFileSync(await svg.path(), "utf8"), /^<svg[\s\S]*<path/);
  const [png] = await Promise.all([page.waitForEvent("download"), page.locator("button:has-text('PNG')").first().click()]);
  assert.equal(readFileSync(await png.path()).subarray(1, 4).toString(), "PNG");
  // The legend switches a curve off and on.
  const toggle = page.locator(".legend button").first();
  await toggle.click();
  assert.equal(await toggle.getAttribute("aria-pressed"), "false");
  await toggle.click();
  // The readout follows the keys.
  await page.locator(".chart[tabindex]").first().focus();
  await page.keyboard.press("Home");
  const first = await page.locator(".legend thead th").nth(1).innerText();
  await page.keyboard.press("ArrowRight");
  assert.notEqual(await page.locator(".legend thead th").nth(1).innerText(), first);
  await shot(page, "noise-light");
  const one = (await address(page)).searchParams.get("run");
  await run(page, "noise", "loud.csv");
  const two = (await address(page)).searchParams.get("run");
  await page.goto(`${base()}/?v=compare&runs=${one},${two}`);
  await page.waitForSelector(".uplot");
  const rows = await page.locator("section[aria-label=Figures]").innerText();
  assert.match(rows, /White noise/);
  assert.equal(await page.locator("section .legend").first().locator("tbody tr").count(), 2);
  await shot(page, "compare-light");
  await page.reload();
  await page.waitForSelector(".uplot");
  await close();
});

test("a run is cancelled, and one that fails says why", async () => {
  const { page, close } = await open();
  await page.goto(`${base()}/?v=analysis&verb=noise&file=rig.csv&o.from=5&o.to=4`);
  await page.waitForSelector("button[type=submit]:not([disabled])");
  await page.click("button[type=submit]");
  await page.waitForSelector(".failure >> text=Noise failed");
  assert.match(await page.locator(".failure").first().innerText(), /must begin before it ends/);
  await page.goto(`${base()}/?v=analysis&verb=tune&file=rig.csv&o.radius=0.1`);
  await page.waitForSelector("button[type=submit]:not([disabled])");
  await page.click("button[type=submit]");
  await page.click("button:has-text('Cancel')", { timeout: 5000 }).catch(() => undefined);
  await page.waitForSelector(".failure, .conclusion", { timeout: patience });
  await close();
});

test("a file is added by the chooser, never over another", async () => {
  const { page, close } = await open();
  await page.waitForSelector("[role=option]");
  await page.setInputFiles("input[type=file]", { name: "quiet.csv", mimeType: "text/csv", buffer: Buffer.from("t (s),x (g)\n0,1\n0.1,2\n") });
  await page.waitForSelector("[role=option] >> text=quiet-2.csv");
  assert.ok(readFileSync(join(folder, "quiet.csv")).length > 1000);
  rmSync(join(folder, "quiet-2.csv"));
  await close();
});

test("axe finds nothing serious in any view, in light and dark, on a desk and on a phone", async () => {
  for (const [name, how] of [["light", {}], ["dark", { scheme: "dark" }], ["phone", { width: 390, height: 844 }], ["phone-dark", { width: 390, height: 844, scheme: "dark" }]]) {
    const { page, close } = await open("", how);
    const visit = async (view, query, ready) => {
      await page.goto(`${base()}/?${query}`);
      await page.waitForSelector(ready, { timeout: patience });
      await page.waitForTimeout(400);
      const wide = await page.evaluate(() => document.querySelector("main").scrollWidth - document.querySelector("main").clientWidth);
      assert.ok(wide <= 1, `${view} ${name}: ${wide} px too wide`);
      await shot(page, `${view}-${name}`);
      await audit(page, `${view} ${name}`);
    };
    await visit("recordings", "v=recordings&file=rig.csv", ".row canvas");
    await visit("recording", "v=recording&file=rig.csv&a=5&b=10&stretch=2,6", ".side .legend");
    await visit("analyses", "v=analysis", ".runs");
    await visit("analysis", "v=analysis&verb=noise&file=quiet.csv&run=1", ".conclusion");
    await visit("compare", "v=compare&runs=1,2", ".uplot");
    await close();
  }
});

test("sensor files are shown, compared and exported", async () => {
  const { page, problems, close } = await open("v=recordings");
  const files = page.locator("section[aria-label='Sensor files']");
  await files.locator("tr", { hasText: "quiet.toml" }).locator("text=Show").click();
  await page.waitForSelector(".conclusion", { timeout: patience });
  assert.match(await page.innerText("main"), /white/i);
  await shot(page, "sensor-show");
  await page.goto(`${base()}/?v=recordings`);
  await files.locator("tr", { hasText: "quiet.toml" }).locator("text=Compare…").click();
  await page.selectOption("select[aria-label='Sensor file 2']", "loud.toml");
  await page.click("button[type=submit]");
  await page.waitForSelector(".conclusion", { timeout: patience });
  await shot(page, "sensor-diff");
  await page.goto(`${base()}/?v=recordings`);
  await files.locator("tr", { hasText: "loud.toml" }).locator("text=Export…").click();
  await page.selectOption("#option-format", "c-header");
  await page.click("button[type=submit]");
  await page.waitForSelector("pre >> text=/#define/", { timeout: patience });
  await shot(page, "sensor-export");
  assert.deepEqual(problems, []);
  await close();
});
