// A live source in Chromium (software rendering) while it is recorded:
//   PROOFMASS=build/release/proofmass node bench/live_bench.mjs [SECONDS [SOURCE [ESTIMATE]]]
// By default six channels at 1 kHz with a wheel's angle, for 30 s. The page itself measures the time
// from a sample's arrival at the recorder to its picture: for each frame that it draws, the time of
// day less that at which the recorder got the frame's first sample. Memory, of all three programs, is
// that after a fifth of the time and at its end: over an hour of "sim:wheel?rate=48000&sensors=4&axes=2"
// (eight channels at 48 kHz) it stays as it is. Needs npm install in tests/page.
import { readFileSync, readdirSync } from "node:fs";
import { base, open, serverPid, start, stop, token } from "../tests/page/browser.mjs";

const seconds = Number(process.argv[2] ?? 30);
const source = process.argv[3] ?? "sim:wheel?rate=1000";
const estimate = process.argv[4] ?? (process.argv[3] ? "" : "wheel");

await start();
const headers = { Authorization: `Bearer ${token()}` };
const made = await fetch(`${base()}/api/live`, { method: "POST", headers, body: JSON.stringify({ source, file: "bench.mcap", options: estimate ? { estimate } : {} }) });
const { id } = await made.json();
const { page, close } = await open(`v=live&source=${id}`);
await page.waitForSelector(".facts >> text=/ms behind/");
const cdp = await page.context().newCDPSession(page);
const megabytes = (bytes) => Math.round(bytes / 1e5) / 10;
const resident = (pid) => 1024 * Number(/VmRSS:\s+(\d+)/.exec(readFileSync(`/proc/${pid}/status`, "utf8"))[1]);
const parent = (pid) => Number(/PPid:\s+(\d+)/.exec(readFileSync(`/proc/${pid}/status`, "utf8"))[1]);
const children = () => readdirSync("/proc").filter((pid) => /^\d+$/.test(pid)).filter((pid) => { try { return parent(pid) === serverPid(); } catch { return false; } });
async function memory() {
  await cdp.send("HeapProfiler.collectGarbage");
  const { usedSize } = await cdp.send("Runtime.getHeapUsage");
  return { serve: megabytes(resident(serverPid())), recorder: megabytes(children().reduce((sum, pid) => sum + resident(pid), 0)), page: megabytes(usedSize) };
}

// The line above the strips is written anew with each frame that is drawn.
await page.evaluate(() => {
  window.drawn = 0;
  new MutationObserver((changes) => (window.drawn += changes.length > 0 ? 1 : 0)).observe(document.querySelector(".facts"), { childList: true });
});
await page.waitForTimeout(200 * seconds);
const first = await memory();
const [drawnBefore, before] = [await page.evaluate(() => window.drawn), Date.now()];
await page.waitForTimeout(800 * seconds);
const rate = (1000 * ((await page.evaluate(() => window.drawn)) - drawnBefore)) / (Date.now() - before);
const last = await memory();
const words = await page.locator(".facts").innerText();
const view = await page.locator("tr.on td[data-label=View]").innerText();
const { last_state: state } = await (await fetch(`${base()}/api/live/${id}`, { headers })).json();
await close();
await fetch(`${base()}/api/live/${id}`, { method: "DELETE", headers });
await stop();
const [, median, most] = /is (\d+) ms behind the samples \(95 %: (\d+) ms\)/.exec(words) ?? [];
console.log(`${source}, ${seconds} s, ${state.samples} samples of each channel, lost ${state.lost}`);
console.log(`sample to picture, median ${median} ms, 95 % within ${most} ms, target 100 ms; frames shown: ${view}`);
console.log(`${rate.toFixed(1)} pictures a second, target 30`);
for (const one of ["serve", "recorder", "page"]) console.log(`memory of ${one}: ${first[one]} MB, then ${last[one]} MB`);
process.exit(Number(most) <= 100 && rate >= 30 ? 0 : 1);
