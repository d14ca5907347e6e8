// The shell around the views: top bar, theme, keys, dropped files, and what is said when the server
// is gone.
import { ApiError, get, onConnection, pause, takeToken, type Info } from "./api";
import { go, link, onMove, params, type Params } from "./address";
import { analysisView } from "./analysis";
import { calibrationView } from "./calibration";
import { compareView } from "./compare";
import { h, light, replace } from "./dom";
import { liveView } from "./live";
import { recordingView } from "./recording";
import { recordingsView } from "./recordings";
import type { View } from "./view";

const app = document.getElementById("app") as HTMLElement;
const main = h("main", { id: "main" });
const offline = h("div", { class: "offline", role: "alert", hidden: true });
const connection = h("span", {}, light("good", location.host));
const folder = h("span", { class: "folder" });
let view: View | undefined;
let info: Info | undefined;

const places: [string, string, Params][] = [
  ["recordings", "Recordings", { v: "recordings" }],
  ["analysis", "Analyses", { v: "analysis" }],
  ["live", "Live", { v: "live" }],
  ["calibration", "Calibration", { v: "calibration" }],
];

function isOn(name: string): boolean {
  const now = params()["v"] ?? "recordings";
  return name === now || (name === "recordings" && now === "recording") || (name === "analysis" && now === "compare");
}

function navigation(className: string): HTMLElement {
  return h("nav", { class: className, "aria-label": className === "tabs" ? "Views, below" : "Views" }, ...places.map(([name, word, to]) => h("a", { ...link(to), "aria-current": isOn(name) ? "page" : undefined }, word)));
}

// Automatic, light, dark, in turn; kept in this browser.
function theme(): HTMLElement {
  const key = "proofmass-theme";
  const set = (wish: string): void => {
    if (wish) document.documentElement.dataset["theme"] = wish;
    else delete document.documentElement.dataset["theme"];
  };
  set(localStorage.getItem(key) ?? "");
  return h("button", { type: "button", class: "icon", "aria-label": "Light or dark", title: "Light or dark", onclick: () => {
    const wishes = ["", "light", "dark"];
    const next = wishes[(wishes.indexOf(localStorage.getItem(key) ?? "") + 1) % wishes.length] ?? "";
    localStorage.setItem(key, next);
    set(next);
    draw();
  } }, "◐");
}

const keys: [string, string][] = [
  ["g r, g a, g l, g c", "recordings, analyses, live, calibration"],
  ["/", "filter the list"],
  ["↑ ↓ Enter", "choose a recording, open it"],
  ["n, k", "noise, calibrate"],
  ["← → + −", "recording: pan, zoom"],
  ["f, Backspace", "fit all, back"],
  ["1 … 9", "channel on, off"],
  ["a b", "cursor to the pointer"],
  ["s", "the view as a stretch, and back"],
  ["[ ]", "mark before, after"],
  ["u", "unit"],
  ["Ctrl Enter", "run an analysis"],
  ["c", "compare a run"],
  ["← → Home End", "readout of the plot in focus"],
  ["space, w", "live: hold the picture, window"],
  ["a, r", "live: add a source, record"],
  ["n, p, e", "calibration: leave a position out, repeat one that contradicts, end"],
  ["Esc", "cancel, close"],
];
const help = h("dialog", { "aria-label": "Keys" }, h("h2", {}, "Keys"), h("table", {}, h("tbody", {}, ...keys.map(([key, what]) => h("tr", {}, h("th", { scope: "row" }, key), h("td", {}, what))))), h("form", { method: "dialog" }, h("button", { class: "btn" }, "Close")));

const top = h("header", { class: "top" });
const tabs = h("div", {});

function draw(): void {
  view?.dispose();
  view = undefined;
  replace(top, h("span", { class: "name" }, "Proofmass"), navigation("views"), h("div", { class: "right" }, folder, connection, theme(), h("button", { type: "button", class: "icon keys", "aria-label": "Keys", onclick: () => help.showModal() }, "?")));
  replace(tabs, navigation("tabs"));
  main.replaceChildren();
  main.scrollTop = 0;
  const now = params();
  const name = now["v"] ?? "recordings";
  if (name === "recording" && now["file"]) view = recordingView(main, now["file"]);
  else if (name === "analysis") view = analysisView(main);
  else if (name === "live") view = liveView(main);
  else if (name === "calibration") view = calibrationView(main);
  else if (name === "compare") view = compareView(main);
  else view = recordingsView(main, info?.folder ?? "");
  document.title = `${now["file"] ? now["file"].split("\n")[0] + " – " : ""}Proofmass`;
}

let prefix = "";
addEventListener("keydown", (event) => {
  const target = event.target as HTMLElement;
  const types = target.matches("input:not([type=checkbox]), select, textarea");
  if (help.open) return;
  if (types && event.key === "Escape") return target.blur();
  if (types && !(event.key === "Enter" && event.ctrlKey)) return;
  if ((event.ctrlKey && event.key !== "Enter") || event.metaKey || event.altKey) return;
  if (target.matches("button, a, summary") && (event.key === "Enter" || event.key === " ") && !event.ctrlKey) return;
  const before = prefix;
  prefix = "";
  if (before === "g") {
    const to = places.find(([name]) => name.startsWith(event.key));
    if (to) go(to[2]);
  } else if (event.key === "g") prefix = "g";
  else if (event.key === "?") help.showModal();
  else if (!view?.key?.(event.key, event)) return;
  event.preventDefault();
});

addEventListener("dragover", (event) => {
  event.preventDefault();
  document.body.classList.toggle("dropping", view?.drop !== undefined);
});
addEventListener("dragleave", () => document.body.classList.remove("dropping"));
addEventListener("drop", (event) => {
  event.preventDefault();
  document.body.classList.remove("dropping");
  if (event.dataTransfer) view?.drop?.([...event.dataTransfer.files]);
});

let gone: number | undefined;
onConnection((connected) => {
  if (connected && gone !== undefined) {
    gone = undefined;
    offline.hidden = true;
    replace(connection, light("good", location.host));
    draw();
  } else if (!connected && gone === undefined) {
    gone = Date.now();
    replace(connection, light("bad", "no connection"));
    void retry();
  }
});
async function retry(): Promise<void> {
  while (gone !== undefined) {
    offline.hidden = false;
    offline.textContent = `The server has not answered for ${Math.round((Date.now() - gone) / 1000)} s. What is shown may be out of date; this page tries again. If serve was ended, begin it anew and open its new link.`;
    await pause(1000);
    await get("/api/info").catch(() => undefined);
  }
}

async function begin(): Promise<void> {
  takeToken();
  try {
    info = await get<Info>("/api/info");
  } catch (problem) {
    const refused = problem instanceof ApiError && problem.status === 403;
    replace(app, h("main", {}, h("div", { class: "head" }, h("h1", {}, "Proofmass")), h("p", {}, refused ? "This page needs the link that proofmass serve printed, with its token: copy it from the terminal." : problem instanceof Error ? problem.message : String(problem))));
    return;
  }
  folder.textContent = info.folder;
  if (info.only && !params()["v"]) history.replaceState(null, "", "/?" + new URLSearchParams({ v: "recording", file: info.only }).toString());
  if (info.source !== null && !params()["v"]) history.replaceState(null, "", "/?" + new URLSearchParams({ v: "live", source: String(info.source) }).toString());
  replace(app, h("a", { class: "only-heard", href: "#main" }, "To the content"), top, offline, main, tabs, help);
  onMove(draw);
  draw();
}

void begin();
