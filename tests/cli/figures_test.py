"""The figures of a page in a browser: zoom, readout, legend, and the way back. Needs Chromium, without which it is skipped."""
import json
import re
import shutil
import subprocess
import unittest

from command import CommandTest

CHROMIUM = shutil.which("chromium") or shutil.which("chromium-browser") or shutil.which("google-chrome")

# Acts on a figure over 0 to 60 s and leaves what it saw as JSON in the page.
ACT = """<script>
const svg = document.querySelectorAll('svg.pm-figure[data-x]')[%d], seen = {};
const box = svg.getBoundingClientRect(), unit = box.width / svg.viewBox.baseVal.width;
const [left, right, low, high] = svg.dataset.x.split(' ').map(Number);
const [foot, head] = svg.dataset.y.split(' ').map(Number);
const fire = (type, x, y) => svg.dispatchEvent(new PointerEvent(type, {bubbles: true, button: 0, pointerId: 1,
    pointerType: 'mouse', clientX: box.left + x * unit, clientY: box.top + y * unit}));
svg.setPointerCapture = () => {};
const at = seconds => left + (seconds - low) / (high - low) * (right - left);
const ticks = () => [...svg.querySelectorAll('.pm-scale .pm-mid')].map(t => t.textContent);
const readout = () => svg.closest('figure').querySelector('.pm-readout').textContent;
const drag = (from, to, y0, y1) => { fire('pointerdown', at(from), y0); fire('pointermove', at(to), y1);
                                     fire('pointerup', at(to), y1); };
const middle = (foot + head) / 2;
seen.drawn = svg.querySelector('.pm-scale').innerHTML;
seen.ticks = ticks();
fire('pointermove', at(30), middle);
seen.read = readout();
drag(20, 30, middle, middle);
seen.zoomed = ticks();
fire('pointermove', (left + right) / 2, middle);
seen.readZoomed = readout();
seen.resetShown = !svg.closest('figure').querySelector('.pm-reset').hidden;
svg.dispatchEvent(new KeyboardEvent('keydown', {key: '+', bubbles: true}));
seen.closer = ticks();
svg.dispatchEvent(new MouseEvent('dblclick', {bubbles: true}));
seen.again = svg.querySelector('.pm-scale').innerHTML;
const entry = svg.querySelector('.pm-legend g'), name = entry.querySelector('text').textContent;
entry.dispatchEvent(new MouseEvent('click', {bubbles: true}));
seen.hidden = [...svg.querySelectorAll('.pm-plot [data-name]')].filter(e => e.dataset.name === name)
    .every(e => getComputedStyle(e).display === 'none');
const out = document.createElement('pre');
out.id = 'seen';
out.textContent = JSON.stringify(seen);
document.body.append(out);
</script>
"""


@unittest.skipUnless(CHROMIUM, "SKIPPED, no Chromium")
class Figures(CommandTest):
    def acted_on(self, page: str, figure: int) -> dict:
        text = (self.folder / page).read_text()
        self.assertEqual(text.count("</body>"), 1)
        (self.folder / "acted.html").write_text(text.replace("</body>", ACT % figure + "</body>"))
        ran = subprocess.run([CHROMIUM, "--headless", "--no-sandbox", "--disable-gpu", "--window-size=1100,900",
                              "--virtual-time-budget=2000", "--dump-dom", f"file://{self.folder}/acted.html"],
                             capture_output=True, text=True, timeout=120)
        found = re.search(r'<pre id="seen">(.*?)</pre>', ran.stdout, re.S)
        self.assertTrue(found, ran.stdout[-500:] + ran.stderr[-2000:])
        return json.loads(found[1].replace("&lt;", "<").replace("&gt;", ">").replace("&amp;", "&"))

    def setUp(self):
        super().setUp()
        self.succeed("simulate", "--rpm", "11", "--seed", "7", "-o", "rig.csv")
        self.succeed("wheel", "rig.csv", "--radius", "0.1", "--report", "wheel.html")

    def test_a_stretch_is_zoomed_read_and_left_again(self):
        seen = self.acted_on("wheel.html", 1)
        self.assertEqual((seen["ticks"][0], seen["ticks"][-1]), ("0", "50"))  # it ends at 59.995 s
        self.assertRegex(seen["read"], r"^Time \(s\): (29\.9|30)")
        inside = [float(tick) for tick in seen["zoomed"]]
        self.assertGreater(len(inside), 4)
        self.assertTrue(all(19.9 <= tick <= 30.1 for tick in inside), inside)
        # Double integration is far off the figure there: what is drawn at its edge is not its value.
        self.assertIn("atan2", seen["readZoomed"])
        self.assertNotIn("double integration", seen["readZoomed"])
        # The middle of the zoomed plot is the middle of the stretch.
        self.assertRegex(seen["readZoomed"], r"^Time \(s\): (24\.9|25\.0)")
        self.assertTrue(seen["resetShown"])
        closer = [float(tick) for tick in seen["closer"]]
        self.assertTrue(all(22.4 <= tick <= 27.6 for tick in closer), closer)
        self.assertEqual(seen["again"], seen["drawn"])
        self.assertTrue(seen["hidden"])


if __name__ == "__main__":
    unittest.main()
