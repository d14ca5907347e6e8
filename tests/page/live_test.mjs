// Live sources and guided calibration on the page, with the digital twin as the device.
import { spawnSync } from "node:child_process";
import { createSocket } from "node:dgram";
import { existsSync, readFileSync } from "node:fs";
import { join } from "node:path";
import { after, before, test } from "node:test";
import assert from "node:assert/strict";
import { address, base, check, folder, open, patience, program, shot, start, stop, token } from "./browser.mjs";

before(start);
after(stop);

const api = async (method, path, body) => {
  const answer = await fetch(base() + path, { method, headers: { Authorization: `Bearer ${token()}` }, body: body && JSON.stringify(body) });
  return { status: answer.status, json: await answer.json() };
};
const begin = async (source, file, options = {}) => {
  const made = await api("POST", "/api/live", { source, file, options });
  assert.equal(made.status, 201, JSON.stringify(made.json));
  return made.json.id;
};
async function until(id, wanted) {
  for (let k = 0; k < patience / 100; ++k) {
    const { json } = await api("GET", `/api/live/${id}`);
    if (wanted(json)) return json;
    await new Promise((done) => setTimeout(done, 100));
  }
  assert.fail("it did not come true");
}
const isOver = (one) => one.state === "ended" || one.state === "failed";
const end = async (id) => {
  const { json } = await api("GET", `/api/live/${id}`);
  if (!isOver(json)) await api("DELETE", `/api/live/${id}`);
  const last = await until(id, isOver);
  await api("DELETE", `/api/live/${id}`);
  return last;
};
const inspect = (file) => JSON.parse(spawnSync(program, ["inspect", file, "--json", "-"], { cwd: folder }).stdout);

test("a source is started by hand, recorded under a new name, and stopped", async () => {
  const { page, close } = await open("v=live");
  await page.waitForSelector("#live-source");
  await page.waitForSelector(".kinds summary");
  await page.fill("#live-source", "sim:wheel?rate=500");
  await page.fill("#live-file", "by-hand");
  await page.click("button:has-text('● Record')");
  await page.waitForSelector("tr.on .recorder >> text=/by-hand.mcap, lost 0/");
  await page.waitForSelector('canvas[aria-label="acc1_x, the last seconds"]');
  await page.waitForSelector(".facts >> text=/ms behind/");
  assert.match(String(await address(page)), /source=\d/);
  await page.click("button:has-text('Hold')");
  await page.waitForSelector("button:has-text('Go on')");
  await page.click("button:has-text('■ Stop')");
  await page.waitForSelector("tr.on .recorder >> text=/by-hand.mcap/");
  await page.click("tr.on button:has-text('Forget')");
  const found = inspect("by-hand.mcap");
  assert.equal(found.channels.length, 6);
  assert.equal(found.timing.gaps.length, 0);
  // Never over a file.
  const again = await api("POST", "/api/live", { source: "sim:wheel", file: "by-hand.mcap" });
  assert.equal(again.status, 400);
  await close();
});

test("the dial shows the twin's angle within its limits", async () => {
  const id = await begin("sim:wheel?rate=200", null, { estimate: "wheel" });
  const { page, close } = await open(`v=live&source=${id}`);
  await page.waitForSelector('svg[aria-label^="Wheel at"]');
  await page.waitForSelector("text=/Turns, (forwards|backwards)/");
  // The same twin with its truth: seed and rate are the same.
  const made = spawnSync(program, ["simulate", "--output", "truth-rig.csv", "--duration", "60", "--rate", "200", "--seed", "1"], { cwd: folder });
  assert.equal(made.status, 0, String(made.stderr));
  const lines = readFileSync(join(folder, "truth-rig.truth.csv"), "utf8").split("\n").filter((line) => line && !line.startsWith("#"));
  const names = lines[0].split(",").map((name) => name.replace(/ \(.*/, ""));
  const rows = lines.slice(1).map((line) => line.split(",").map(Number));
  const column = (name) => names.findIndex((one) => one === name);
  const seen = new Set();
  let within = 0;
  let worst = "";
  while (seen.size < 40) {
    const shown = await page.locator("section[aria-label=Wheel]").evaluate((panel) => ({ ...panel.dataset }));
    const time = Number(shown.time);
    if (seen.has(time) || !Number.isFinite(Number(shown.angle))) {
      await page.waitForTimeout(50);
      continue;
    }
    seen.add(time);
    const at = rows[Math.round(time * 200)];
    assert.ok(Math.abs(at[column("time")] - time) < 1e-6, `${at[column("time")]} ${time}`);
    const off = Math.abs(Number(shown.angle) - at[column("angle")]);
    if (off < 3 * Number(shown.std)) ++within;
    else worst = `${off} with ${shown.std} at ${time} s`;
    await page.waitForTimeout(100);
  }
  assert.ok(within >= 36, `${within} of 40 within three standard deviations; ${worst}`);
  await shot(page, "live-wheel-light");
  await end(id);
  await close();
});

test("two browsers watch one source, and a reload in the middle of a recording finds it again", async () => {
  const id = await begin("sim:wheel?rate=1000", "watched.mcap", { estimate: "wheel" });
  const one = await open(`v=live&source=${id}`);
  const two = await open(`v=live&source=${id}`, { scheme: "dark" });
  for (const { page } of [one, two]) await page.waitForSelector(".facts >> text=/ms behind/");
  await one.page.reload();
  await one.page.waitForSelector("tr.on .recorder >> text=/watched.mcap, lost 0/");
  await one.page.waitForSelector('canvas[aria-label="acc2_z, the last seconds"]');
  // What came before the reload is there: the strip is not empty at its left.
  await one.page.waitForSelector(".facts >> text=/ms behind/");
  await two.close();
  await one.close();
  const last = await end(id);
  assert.equal(last.last_end.lost, 0);
  assert.equal(last.last_end.gaps, 0);
  assert.equal(inspect("watched.mcap").samples, last.last_end.samples);
});

test("lights show a loss, a gap and a silent source", async () => {
  const id = await begin("sim:wheel?rate=200&drop=0.05&stall=6,20", null);
  const { page, close } = await open(`v=live&source=${id}`);
  await page.waitForSelector("tr.on td[data-label=Loss] .light-mark.bad");
  await page.waitForSelector("tr.on td[data-label=Gaps] .light-mark.warning");
  await page.waitForSelector("tr.on td[data-label=Silence] >> text=/nothing for/");
  await page.waitForSelector("section[aria-label=Events] li.warning");
  await end(id);
  await close();
});

test("a recorder that is killed does not take the page with it", async () => {
  const id = await begin("sim:wheel", "killed.mcap");
  const { page, close } = await open(`v=live&source=${id}`);
  await page.waitForSelector(".facts >> text=/ms behind/");
  // Its command line names the file.
  const pids = spawnSync("pgrep", ["-f", "output=killed[.]mcap"]).stdout.toString().trim().split("\n");
  assert.equal(pids.length, 1);
  process.kill(Number(pids[0]), "SIGKILL");
  await page.waitForSelector("tr.on .recorder >> text=/crashed.*9/");
  assert.ok(existsSync(join(folder, "killed.mcap.part")));
  await page.waitForSelector(".top >> text=127.0.0.1");
  await end(id);
  await close();
});

test("noise and spectrum grow while a source is watched", async () => {
  const id = await begin("sim:static?rate=200", null);
  const { page, close } = await open(`v=live&source=${id}`);
  await page.waitForSelector("section[aria-label=Noise] .uplot", { timeout: patience });
  const longest = async () => {
    const text = await page.locator("section[aria-label=Noise] .pb p").first().innerText();
    return Number(/all ([\d.]+) s/.exec(text)?.[1]);
  };
  const before = await longest();
  for (let k = 0; k < 100 && (await longest()) <= before; ++k) await page.waitForTimeout(200);
  assert.ok((await longest()) > before);
  await page.click("button:has-text('Spectrum')");
  await page.waitForSelector("section[aria-label=Samples] .uplot");
  await end(id);
  await close();
});

test("estimates are sent to a controller on this machine", async () => {
  const controller = createSocket("udp4");
  await new Promise((done) => controller.bind(0, "127.0.0.1", done));
  const heard = new Promise((found) => controller.once("message", (datagram) => found(JSON.parse(String(datagram)))));
  const { page, close } = await open("v=live");
  await page.waitForSelector("#live-source");
  await page.fill("#live-source", "sim:wheel?rate=200");
  assert.equal(await page.isVisible("#live-send-to"), false);
  await page.selectOption("#live-what", "wheel");
  await page.fill("#live-send-to", "udp:10.1.2.3:9000");
  await page.click("button:has-text('Watch only')");
  await page.waitForSelector(".failure >> text=/this machine|127.0.0.1/");
  await page.fill("#live-send-to", `udp:127.0.0.1:${controller.address().port}`);
  await page.click("button:has-text('Watch only')");
  const first = await heard;
  assert.ok(Number.isFinite(first.angle) && first.angle_std > 0, JSON.stringify(first));
  controller.close();
  await end(Number((await address(page)).searchParams.get("source")));
  await close();
});

test("a guided calibration ends with a certificate and a sensor file", async () => {
  const { page, close } = await open("v=calibration");
  await page.waitForSelector("#live-source");
  await page.fill("#live-source", "sim:multi-position?seed=1&speed=8");
  await page.fill("#live-file", "cal");
  await page.click("form button:has-text('Begin')");
  await page.waitForSelector(".say >> text=/Position [0-9]+:/");
  await page.waitForSelector(".sphere .next");
  await page.waitForSelector(".sphere .done");
  await page.waitForSelector(".residuals .residual");
  await page.waitForSelector(".sphere .shade");
  await page.waitForSelector('svg[aria-label="The sensor wanted"] .face');
  assert.match(await page.locator("table.figures").innerText(), /x.*±.*±.*yz.*±/);
  await shot(page, "guided-light");
  await page.waitForSelector("section[aria-label=Result] >> text=Calibrated");
  assert.match(readFileSync(join(folder, "cal.toml"), "utf8"), /\[calibration/);
  assert.match(readFileSync(join(folder, "cal.html"), "utf8"), /<!doctype html>/i);
  const [download] = await Promise.all([page.waitForEvent("download"), page.click("button:has-text('Sensor file')")]);
  assert.equal(readFileSync(await download.path(), "utf8"), readFileSync(join(folder, "cal.toml"), "utf8"));
  assert.ok((await page.locator(".sphere .done").count()) >= 12);
  await close();
});

test("axe finds nothing serious, in light and dark, on a desk and on a phone", async () => {
  const wheel = await begin("sim:wheel?rate=1000", null, { estimate: "wheel" });
  const tilt = await begin("sim:static?rate=100", null, { estimate: "tilt" });
  const poses = await begin("sim:multi-position?seed=1", "axe.mcap", { procedure: "multi-position" });
  for (const [name, how] of [["light", { height: 1100 }], ["dark", { scheme: "dark", height: 1100 }], ["phone", { width: 390, height: 844 }], ["phone-dark", { width: 390, height: 844, scheme: "dark" }]]) {
    const { page, close } = await open(`v=live&source=${wheel}`, how);
    await page.waitForSelector('svg[aria-label^="Wheel at"]');
    await page.waitForSelector("section[aria-label=Noise] .uplot");
    await check(page, `live-${name}`);
    await page.click("button:has-text('Add source')");
    await page.waitForSelector(".kinds summary");
    await check(page, `live-add-${name}`);
    await page.goto(`${base()}/?v=live&source=${tilt}`);
    await page.waitForSelector('svg[aria-label^="Roll"]');
    await check(page, `live-tilt-${name}`);
    await page.goto(`${base()}/?v=calibration&source=${poses}`);
    await page.waitForSelector(".sphere .next");
    await check(page, `calibration-${name}`);
    await close();
  }
  for (const id of [wheel, tilt, poses]) await end(id);
});
