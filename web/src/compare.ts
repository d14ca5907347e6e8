// Results of several runs side by side: their main curves in one plot, their figures in one table.
import { get, listAnalyses, type Analysis, type Page } from "./api";
import { go, link, params } from "./address";
import { addressOf } from "./analysis";
import { h, replace } from "./dom";
import { figuresOf, mergedFigure, type Named } from "./merge";
import { draw, type Drawn } from "./plot";
import type { View } from "./view";

const inks = ["blue", "orange", "green", "purple", "red", "grey"];

export function compareView(main: HTMLElement): View {
  let ended = false;
  const plots: Drawn[] = [];
  const chosen = (params()["runs"] ?? "").split(",").map(Number).filter((id) => id > 0);
  const letter = (k: number): string => String.fromCharCode(65 + k);
  const show = (ids: number[]): void => go({ v: "compare", runs: ids.join(",") });

  async function open(): Promise<void> {
    const runs = (await listAnalyses()).filter((run) => run.state === "done");
    const picked = chosen.flatMap((id) => runs.find((run) => run.id === id) ?? []);
    const pages = await Promise.all(picked.map((run) => get<Page>(`/api/analyses/${run.id}/page.json`)));
    if (ended) return;
    const verb = picked[0]?.verb;
    const others = runs.filter((run) => !chosen.includes(run.id) && (!verb || run.verb === verb));
    const add = h("select", { "aria-label": "Add a run" }, h("option", { value: "" }, others.length > 0 ? "Add run…" : "no other run of this verb"), ...others.map((run) => h("option", { value: run.id }, `${run.id} ${run.command}`)));
    add.addEventListener("change", () => add.value && show([...chosen, Number(add.value)]));
    const chip = (run: Analysis, k: number): HTMLElement =>
      h("span", { class: `chip ink-${inks[k % inks.length]}` }, h("span", { class: "badge" }, letter(k)), h("a", { ...link(addressOf(run)) }, run.command.replace(/^proofmass \S+ /, "")), h("button", { type: "button", class: "btn small", "aria-label": `Leave ${letter(k)} out`, onclick: () => show(chosen.filter((id) => id !== run.id)) }, "×"));
    replace(
      main,
      h("div", { class: "head" }, h("a", { ...(picked[0] ? link(addressOf(picked[0])) : link({ v: "analysis" })) }, "‹ Back"), h("h1", {}, "Compare"), ...picked.map(chip), add, picked.length === 2 && h("button", { type: "button", class: "btn", onclick: () => show([...chosen].reverse()) }, "Swap")),
      picked.length === 0 && h("p", { class: "empty" }, "No run is chosen: begin an analysis, or add one that is done."),
    );
    // One channel each; several channels of a run are distinguished by their names.
    const named: Named[] = pages.map((page, k) => ({ page, name: `${letter(k)} ${picked[k]?.files[0]?.split("/").at(-1) ?? ""}`, ink: inks[k % inks.length] ?? "grey" }));
    const titles = [...new Set(pages.flatMap((page) => figuresOf(page).map((figure) => figure.title)))].filter((title) => pages.every((page) => figuresOf(page).some((figure) => figure.title === title)));
    for (const title of pages.length > 0 ? titles : []) {
      const figure = mergedFigure(named, new RegExp(`^${title.replace(/[.*+?^${}()|[\]\\]/g, "\\$&")}$`));
      if (!figure) continue;
      const actions: { name: string; act: () => void }[] = [];
      const drawn = draw({ ...figure, height: 380 }, { actions });
      plots.push(drawn);
      main.append(h("section", { class: "panel", "aria-label": title }, h("div", { class: "ph" }, h("h2", {}, title), h("span", { class: "r" }, ...actions.map((action) => h("button", { type: "button", class: "btn small", onclick: action.act, "aria-label": `${title} as ${action.name}` }, action.name)))), h("div", { class: "pb" }, drawn.element)));
    }
    if (pages.length > 0) {
      const labels = [...new Set(pages.flatMap((page) => page.key_figures.map((figure) => figure.label)))];
      const value = (page: Page, label: string): string => page.key_figures.find((figure) => figure.label === label)?.value ?? "–";
      main.append(
        h("section", { class: "panel", "aria-label": "Figures" }, h("div", { class: "ph" }, h("h2", {}, "Figures")), h("div", { class: "pb wide", tabindex: "0" }, h("table", {}, h("thead", {}, h("tr", {}, h("th", { scope: "col" }, "Figure"), ...pages.map((_, k) => h("th", { scope: "col", class: "num" }, letter(k))))), h("tbody", {}, ...labels.map((label) => h("tr", {}, h("th", { scope: "row" }, label), ...pages.map((page) => h("td", { class: "num" }, value(page, label))))), h("tr", {}, h("th", { scope: "row" }, "Conclusion"), ...pages.map((page) => h("td", {}, page.conclusion))))))),
      );
    }
  }
  open().catch((problem: unknown) => replace(main, h("p", { class: "failure" }, problem instanceof Error ? problem.message : String(problem))));
  return {
    dispose: () => {
      ended = true;
      for (const one of plots) one.dispose();
    },
    key: (key) => {
      if (key !== "Escape") return false;
      history.back();
      return true;
    },
  };
}
