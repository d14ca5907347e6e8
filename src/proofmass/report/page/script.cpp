#include "proofmass/report/page/script.hpp"

namespace proofmass::report {

std::string_view page_script_css() {
  return R"(.pm-plot path{vector-effect:non-scaling-stroke}
.pm-live{position:relative}.pm-live svg:focus:not(:focus-visible){outline:none}
.pm-live svg{cursor:crosshair;touch-action:pan-y;outline-offset:4px}
.pm-live .pm-legend g{cursor:pointer}.pm-off{display:none}.pm-legend .pm-faint{opacity:.35}
.pm-cross{stroke:var(--soft);stroke-width:1;pointer-events:none}
.pm-select{fill:var(--blue);fill-opacity:.12;stroke:var(--blue);pointer-events:none}
.pm-readout{position:absolute;pointer-events:none;background:var(--paper);border:1px solid var(--rule);
border-radius:4px;padding:.3rem .55rem;font-size:.8rem;line-height:1.45;white-space:nowrap;z-index:1;
font-variant-numeric:tabular-nums;box-shadow:0 2px 8px #0002}.pm-readout small{color:var(--soft)}
.pm-readout i{display:inline-block;width:.6rem;height:.6rem;border-radius:2px;background:var(--c);margin-right:.4rem}
.pm-reset{position:absolute;right:0;top:0;font:inherit;font-size:.8rem;color:var(--ink);cursor:pointer;
background:var(--panel);border:1px solid var(--rule);border-radius:4px;padding:.15rem .6rem}
@media print{.pm-readout,.pm-reset,.pm-cross,.pm-select{display:none}}
)";
}

std::string_view page_script() {
  return R"JS((() => {
'use strict';
const make = (name, attributes, parent) => {
  const element = document.createElementNS('http://www.w3.org/2000/svg', name);
  for (const key in attributes) element.setAttribute(key, attributes[key]);
  parent.append(element);
  return element;
};

// Positions along an axis are u = value, or log10(value) on a log axis; `view` is what is shown.
const axisOf = text => {
  const [from, to, low, high] = text.split(' ', 4).map(Number), log = text.endsWith('log');
  const u = v => log ? Math.log10(v) : v, home = [u(low), u(high)];
  return {
    from, to, log, home, view: home.slice(),
    value: u => log ? 10 ** u : u,
    drawn(px) { return this.home[0] + (px - from) / (to - from) * (this.home[1] - this.home[0]); },
    shown(px) { return this.view[0] + (px - from) / (to - from) * (this.view[1] - this.view[0]); },
    place(u) { return from + (u - this.view[0]) / (this.view[1] - this.view[0]) * (to - from); },
    // px as drawn -> scale * px + shift as shown
    scale() { return (this.home[1] - this.home[0]) / (this.view[1] - this.view[0]); },
    shift() { return this.place(this.home[0]) - this.scale() * from; },
    zoomed() { return this.view[0] !== this.home[0] || this.view[1] !== this.home[1]; },
    // Never beyond what is drawn, nor finer than its coordinates resolve.
    show(low, high) {
      const range = this.home[1] - this.home[0], least = range / 2000;
      const width = Math.min(range, Math.max(least, high - low));
      const start = Math.min(Math.max(this.home[0], (low + high - width) / 2), this.home[1] - width);
      this.view = width === range ? this.home.slice() : [start, start + width];
    },
  };
};

const number = (value, decimals) => {
  const size = Math.abs(value);
  const text = size !== 0 && (size >= 1e6 || size < 1e-5)
      ? value.toExponential(Math.max(0, decimals + Math.floor(Math.log10(size))))
          .replace(/e\+?(-?)(\d+)/, (_, minus, digits) => '·10' + (minus ? '⁻' : '') +
              [...digits].map(d => '⁰¹²³⁴⁵⁶⁷⁸⁹'[d]).join(''))
      : value.toFixed(Math.min(20, Math.max(0, decimals)));
  return text.replace('-', '−');
};

// 1, 2 or 5 times a power of ten apart.
const linearTicks = (low, high, most) => {
  const raw = (high - low) / most, power = 10 ** Math.floor(Math.log10(raw));
  const step = [1, 2, 5, 10].find(factor => factor * power >= raw * (1 - 1e-12)) * power;
  const decimals = -Math.floor(Math.log10(step) + 1e-9), ticks = [];
  for (let k = Math.ceil(low / step - 1e-9); k * step <= high + 1e-9 * step; ++k)
    ticks.push([k * step, number(k * step, decimals)]);
  return ticks;
};

const ticksOf = (axis, most) => {
  const [low, high] = axis.view;
  if (!axis.log) return linearTicks(low, high, most);
  if (high - low < 0.7)
    return linearTicks(10 ** low, 10 ** high, most).filter(([v]) => v > 0)
        .map(([v, label]) => [Math.log10(v), label]);
  const ticks = [], digits = high - low < most / 3 ? [1, 2, 5] : [1];
  for (let power = Math.floor(low); power <= high; ++power)
    for (const digit of digits) {
      const u = power + Math.log10(digit);
      if (u >= low && u <= high) ticks.push([u, number(digit * 10 ** power, -power)]);
    }
  return ticks;
};

const pointsOf = path => [...path.getAttribute('d').matchAll(/(-?[\d.]+),(-?[\d.]+)/g)]
    .map(found => [+found[1], +found[2]]);

const enliven = svg => {
  const figure = svg.closest('figure') || svg.parentElement;
  const x = axisOf(svg.dataset.x), y = axisOf(svg.dataset.y);
  const plot = svg.querySelector('.pm-plot'), scale = svg.querySelector('.pm-scale');
  const drawnScale = scale.innerHTML;
  const shapes = [...plot.querySelectorAll('path')];
  const spots = [...plot.querySelectorAll('circle,text')].map(element => {
    const keys = element.tagName === 'circle' ? ['cx', 'cy'] : ['x', 'y'];
    return {element, keys, at: keys.map(key => +element.getAttribute(key))};
  });
  // Dots of one curve carry its name; a band's outline goes forth above and back below.
  const named = new Map();
  for (const element of plot.querySelectorAll('[data-name]')) {
    const name = element.dataset.name, band = element.classList.contains('pm-band');
    const key = name + (band ? '|band' : '');
    if (!named.has(key)) named.set(key, {name, band, elements: [], points: null});
    named.get(key).elements.push(element);
  }
  const dataOf = series => series.points ??= series.elements.flatMap(element => {
    if (element.tagName === 'circle') return [[+element.getAttribute('cx'), +element.getAttribute('cy')]];
    if (!series.band) return pointsOf(element);
    return element.getAttribute('d').split('Z').flatMap(piece => {
      const outline = [...piece.matchAll(/(-?[\d.]+),(-?[\d.]+)/g)].map(f => [+f[1], +f[2]]);
      const half = outline.length / 2;
      return outline.slice(0, half).map((p, k) => [p[0], p[1], outline[outline.length - 1 - k][1]]);
    });
  });
  // A curve that leaves the figure is drawn far outside of it, not at its value.
  const isInside = py => py >= y.to - 1 && py <= y.from + 1;
  const isShown = series => !series.elements[0].classList.contains('pm-off');

  figure.classList.add('pm-live');
  svg.setAttribute('tabindex', '0');
  const cross = make('path', {class: 'pm-cross', visibility: 'hidden'}, svg);
  const select = make('rect', {class: 'pm-select', visibility: 'hidden'}, svg);
  const readout = document.createElement('div');
  readout.className = 'pm-readout';
  readout.hidden = true;
  const reset = document.createElement('button');
  reset.className = 'pm-reset';
  reset.type = 'button';
  reset.textContent = 'Reset zoom';
  reset.hidden = true;
  figure.append(readout, reset);

  const drawScale = () => {
    if (!x.zoomed() && !y.zoomed()) return void (scale.innerHTML = drawnScale);
    scale.textContent = '';
    for (const [u, label] of ticksOf(y, Math.max(3, Math.floor((y.from - y.to) / 48)))) {
      const at = y.place(u).toFixed(1);
      make('path', {class: 'pm-grid', d: `M${x.from},${at}H${x.to}`}, scale);
      make('text', {class: 'pm-tick pm-end', x: x.from - 8, y: +at + 4}, scale).textContent = label;
    }
    for (const [u, label] of ticksOf(x, 10)) {
      const at = x.place(u).toFixed(1);
      make('path', {class: 'pm-grid', d: `M${at},${y.from}V${y.to}`}, scale);
      make('text', {class: 'pm-tick pm-mid', x: at, y: y.from + 18}, scale).textContent = label;
    }
  };
  const draw = () => {
    const a = x.scale(), b = x.shift(), c = y.scale(), d = y.shift();
    for (const shape of shapes) {
      shape.setAttribute('transform', shape.classList.contains('pm-events')
          ? `matrix(${a} 0 0 1 ${b} 0)` : `matrix(${a} 0 0 ${c} ${b} ${d})`);
    }
    for (const {element, keys, at} of spots) {
      // A word stays as far from its dot as drawn: only the dot's place is scaled.
      const offset = element.tagName === 'text' ? [+element.dataset.dx || 0, +element.dataset.dy || 0] : [0, 0];
      element.setAttribute(keys[0], a * (at[0] - offset[0]) + b + offset[0]);
      element.setAttribute(keys[1], c * (at[1] - offset[1]) + d + offset[1]);
    }
    drawScale();
    reset.hidden = !x.zoomed() && !y.zoomed();
    cross.setAttribute('visibility', 'hidden');
    readout.hidden = true;
  };
  // y follows what is seen between the ends of x.
  const fitY = () => {
    let low = Infinity, high = -Infinity;
    for (const series of named.values()) {
      if (!isShown(series)) continue;
      for (const [px, ...py] of dataOf(series)) {
        const u = x.drawn(px);
        if (u < x.view[0] || u > x.view[1]) continue;
        for (const value of py.filter(isInside)) { low = Math.min(low, y.drawn(value)); high = Math.max(high, y.drawn(value)); }
      }
    }
    if (!(high >= low)) return;
    const room = 0.05 * (high - low);
    y.show(low - room, high + room);
  };
  const home = () => { x.view = x.home.slice(); y.view = y.home.slice(); draw(); };

  const placeOf = event => {
    const point = new DOMPoint(event.clientX, event.clientY).matrixTransform(svg.getScreenCTM().inverse());
    return [Math.min(Math.max(point.x, x.from), x.to), Math.min(Math.max(point.y, y.to), y.from)];
  };
  const reading = (axis, u) => {
    const value = axis.value(u);
    const finest = Math.abs(axis.value(u + (axis.view[1] - axis.view[0]) / 2000) - value);
    return number(value, -Math.floor(Math.log10(finest || 1)));
  };
  let readAt = null;
  const read = ([px, py]) => {
    readAt = px;
    const drawnX = x.from + (x.shown(px) - x.home[0]) / (x.home[1] - x.home[0]) * (x.to - x.from);
    const drawnY = (py - y.shift()) / y.scale();
    const lines = [];
    let at = null;
    for (const series of named.values()) {
      if (!isShown(series)) continue;
      let best = null, least = Infinity;
      for (const point of dataOf(series)) {
        const far = Math.abs(point[0] - drawnX) + 1e-3 * Math.abs(point[1] - drawnY);
        if (far < least) { least = far; best = point; }
      }
      if (!best || Math.abs(best[0] - drawnX) * x.scale() > 25 || !best.slice(1).every(isInside)) continue;
      if (at === null && !series.band) at = best[0];
      const text = series.band ? `${reading(y, y.drawn(best[2]))} … ${reading(y, y.drawn(best[1]))}`
                               : reading(y, y.drawn(best[1]));
      lines.push([series, text]);
    }
    readout.textContent = '';
    const head = document.createElement('div');
    head.textContent = `${svg.dataset.label}: ${reading(x, x.drawn(at ?? drawnX))}`;
    readout.append(head);
    for (const [series, text] of lines) {
      const line = document.createElement('div'), mark = document.createElement('i');
      mark.className = [...series.elements[0].classList].find(c => /^pm-(blue|orange|green|purple|red|grey)$/.test(c)) || '';
      line.append(mark, `${series.name}  ${text}`);
      readout.append(line);
    }
    const hint = document.createElement('small');
    hint.textContent = reset.hidden ? 'drag to zoom' : 'double-click to reset';
    readout.append(hint);
    const shownX = at === null ? px : x.scale() * at + x.shift();
    cross.setAttribute('d', `M${shownX.toFixed(1)},${y.from}V${y.to}`);
    cross.setAttribute('visibility', 'visible');
    readout.hidden = false;
    const box = svg.getBoundingClientRect(), outer = figure.getBoundingClientRect();
    const unit = box.width / svg.viewBox.baseVal.width;
    const left = box.left - outer.left + shownX * unit;
    const right = left + 14 + readout.offsetWidth <= outer.width;
    readout.style.left = `${right ? left + 14 : Math.max(0, left - 14 - readout.offsetWidth)}px`;
    readout.style.top = `${box.top - outer.top + y.to * unit + 6}px`;
  };
  const quiet = () => { cross.setAttribute('visibility', 'hidden'); readout.hidden = true; readAt = null; };

  let start = null;
  svg.addEventListener('pointerdown', event => {
    if (event.button !== 0 || event.target.closest('.pm-legend')) return;
    start = placeOf(event);
    svg.setPointerCapture(event.pointerId);
    event.preventDefault();
    svg.focus({preventScroll: true});
  });
  const box = at => {
    const tall = Math.abs(at[1] - start[1]) > 20;
    const [top, bottom] = tall ? [Math.min(at[1], start[1]), Math.max(at[1], start[1])] : [y.to, y.from];
    return {left: Math.min(at[0], start[0]), right: Math.max(at[0], start[0]), top, bottom, tall};
  };
  svg.addEventListener('pointermove', event => {
    const at = placeOf(event);
    if (!start) return event.pointerType === 'touch' ? undefined : read(at);
    const {left, right, top, bottom} = box(at);
    for (const [key, value] of Object.entries({x: left, y: top, width: right - left, height: bottom - top,
        visibility: 'visible'})) select.setAttribute(key, value);
  });
  svg.addEventListener('pointerup', event => {
    if (!start) return;
    const at = placeOf(event), {left, right, top, bottom, tall} = box(at);
    start = null;
    select.setAttribute('visibility', 'hidden');
    if (right - left < 8) return read(at);
    const low = x.shown(left), high = x.shown(right), foot = y.shown(bottom), head = y.shown(top);
    x.show(low, high);
    if (tall) y.show(foot, head); else fitY();
    draw();
  });
  svg.addEventListener('pointercancel', () => { start = null; select.setAttribute('visibility', 'hidden'); });
  svg.addEventListener('pointerleave', quiet);
  svg.addEventListener('blur', quiet);
  svg.addEventListener('dblclick', home);
  reset.addEventListener('click', home);
  addEventListener('beforeprint', home);
  svg.addEventListener('keydown', event => {
    const width = x.view[1] - x.view[0], middle = (x.view[0] + x.view[1]) / 2;
    const moves = {
      '+': () => x.show(middle - width / 4, middle + width / 4), '-': () => x.show(middle - width, middle + width),
      ArrowLeft: () => x.show(x.view[0] - width / 4, x.view[1] - width / 4),
      ArrowRight: () => x.show(x.view[0] + width / 4, x.view[1] + width / 4),
    };
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    if (event.key === '0' || event.key === 'Escape') home();
    else if (moves[event.key]) { moves[event.key](); if (x.zoomed()) fitY(); else y.view = y.home.slice(); draw(); }
    else return;
    event.preventDefault();
  });
  for (const entry of svg.querySelectorAll('.pm-legend g')) {
    const name = entry.querySelector('text').textContent;
    const its = [...named.values()].filter(series => series.name === name);
    if (!its.length) continue;
    entry.addEventListener('click', () => {
      const off = entry.classList.toggle('pm-faint');
      for (const series of its) for (const element of series.elements) element.classList.toggle('pm-off', off);
    });
  }
};
for (const svg of document.querySelectorAll('svg.pm-figure[data-x]')) enliven(svg);
})();
)JS";
}

}  // namespace proofmass::report
