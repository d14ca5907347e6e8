// From a sample's arrival at the recorder to its picture in Chromium, at 6 channels and 1 kHz, while
// it is recorded and a wheel's angle is estimated:
//   PROOFMASS=build/release/proofmass node bench/live_bench.mjs [SECONDS]
// The page itself measures: for each frame that it draws, the time of day less that at which the
// recorder got the frame's first sample. Needs npm install in tests/page.
import { base, open, start, stop, token } from "../tests/page/browser.mjs";

const seconds = Number(process.argv[2] ?? 30);
await start();
const headers = { Authorization: `Bearer ${token()}` };
const made = await fetch(`${base()}/api/live`, { method: "POST", headers, body: JSON.stringify({ source: "sim:wheel?rate=1000", file: "bench.mcap", options: { estimate: "wheel" } }) });
const { id } = await made.json();
const { page, close } = await open(`v=live&source=${id}`);
await page.waitForSelector(".facts >> text=/ms behind/");
await page.waitForTimeout(1000 * seconds);
const words = await page.locator(".facts").innerText();
const view = await page.locator("tr.on td[data-label=View]").innerText();
await close();
await fetch(`${base()}/api/live/${id}`, { method: "DELETE", headers });
await stop();
const [, median, most] = /is (\d+) ms behind the samples \(95 %: (\d+) ms\)/.exec(words) ?? [];
console.log(`sample to picture, median ${median} ms, 95 % within ${most} ms, target 100 ms; frames shown: ${view}`);
process.exit(Number(most) <= 100 ? 0 : 1);
