// A server on a folder of its own, and Chromium: what the tests of the page begin with. They are
// skipped, with a word, where Chromium or the packages of package.json are missing.
import { spawn } from "node:child_process";
import { existsSync, mkdtempSync, readFileSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import assert from "node:assert/strict";

const chromiumPath = ["/usr/bin/chromium", "/usr/bin/chromium-browser", "/usr/bin/google-chrome"].find(existsSync);
let chromium, axe;
try {
  ({ chromium } = await import("playwright-core"));
  axe = readFileSync(new URL("node_modules/axe-core/axe.min.js", import.meta.url), "utf8");
} catch {
  chromium = undefined;
}
if (!chromium || !chromiumPath) {
  console.log(`SKIPPED, ${chromium ? "there is no Chromium" : "npm install in tests/page has not been run"}`);
  process.exit(0);
}

export const program = process.env.PROOFMASS;
export const patience = 180_000; // ms; other builds may run on this machine
export const folder = mkdtempSync(join(tmpdir(), "proofmass-page-"));
const shots = process.env.PROOFMASS_SCREENSHOTS; // a folder, to look at what was seen
let server, browser, link;

export async function start() {
  server = spawn(program, ["serve", "--no-browser"], { cwd: folder });
  link = await new Promise((found) => server.stdout.once("data", (data) => found(String(data).trim())));
  browser = await chromium.launch({ executablePath: chromiumPath, args: ["--no-sandbox"] });
}

export async function stop() {
  await browser?.close();
  const ended = new Promise((done) => server.once("exit", done));
  server.kill("SIGINT");
  assert.equal(await ended, 130);
  rmSync(folder, { recursive: true });
}

export const base = () => link.split("/?")[0];
export const token = () => new URL(link).searchParams.get("token");
export const serverPid = () => server.pid;
export const newContext = () => browser.newContext();

export async function open(query = "", { width = 1280, height = 900, scheme = "light" } = {}) {
  const context = await browser.newContext({ viewport: { width, height }, colorScheme: scheme, acceptDownloads: true });
  const page = await context.newPage();
  page.setDefaultTimeout(patience);
  const problems = [];
  page.on("pageerror", (error) => problems.push(String(error)));
  page.on("console", (said) => said.type() === "error" && !/40[03]/.test(said.text()) && problems.push(said.text()));
  page.on("request", (request) => !request.url().startsWith(base()) && !/^(blob|data):/.test(request.url()) && problems.push(`asks ${request.url()}`));
  await page.goto(link);
  await page.waitForSelector("nav a", { state: "attached" });
  if (query) await page.goto(`${base()}/?${query}`);
  return { page, problems, close: async () => { assert.deepEqual(problems, []); await context.close(); } };
}

// As the page has it: page.url() learns of a change of the history only some time later.
export const address = async (page) => new URL(await page.evaluate(() => location.href));

export const shot = async (page, name) => void (shots && (await page.screenshot({ path: join(shots, `${name}.png`) })));

// Outside the page's own policy, which lets no other script in.
export async function audit(page, name) {
  const cdp = await page.context().newCDPSession(page);
  await cdp.send("Runtime.evaluate", { expression: axe });
  const found = await cdp.send("Runtime.evaluate", { expression: "axe.run(document, {resultTypes: ['violations']}).then((r) => JSON.stringify(r.violations.filter((v) => v.impact === 'serious' || v.impact === 'critical').map((v) => [v.id, v.nodes.slice(0, 3).map((n) => n.html)])))", awaitPromise: true, returnByValue: true });
  assert.equal(found.result.value, "[]", name);
}

/// Nothing sticks out of the page's width, and axe finds nothing serious.
export async function check(page, name) {
  const wide = await page.evaluate(() => {
    const main = document.querySelector("main");
    const right = main.getBoundingClientRect().left + main.clientWidth;
    const beyond = [...main.querySelectorAll("*")].filter((element) => element.getBoundingClientRect().right > right + 1);
    return { by: main.scrollWidth - main.clientWidth, beyond: beyond.slice(0, 5).map((element) => element.outerHTML.slice(0, 200)) };
  });
  assert.ok(wide.by <= 1, `${name}: ${wide.by} px too wide: ${wide.beyond.join("\n")}`);
  await shot(page, name);
  await audit(page, name);
}
