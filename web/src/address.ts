// What is shown stands in the address, so that reload, back and bookmarks bring it back.

export type Params = { [name: string]: string };

export function params(): Params {
  return Object.fromEntries(new URLSearchParams(location.search));
}

function href(to: Params): string {
  const words = Object.entries(to).filter(([, value]) => value !== "");
  return "/?" + new URLSearchParams(words).toString();
}

let draw: () => void = () => {};
export function onMove(redraw: () => void): void {
  draw = redraw;
  addEventListener("popstate", redraw);
}

/// Shows another view.
export function go(to: Params): void {
  history.pushState(null, "", href(to));
  draw();
}

/// Notes a change of the view that is shown, without drawing it anew.
export function note(change: Params): void {
  history.replaceState(null, "", href({ ...params(), ...change }));
}

/// A link that the browser can open in another tab as well.
export function link(to: Params): { href: string; onclick: (event: MouseEvent) => void } {
  return {
    href: href(to),
    onclick: (event) => {
      if (event.ctrlKey || event.metaKey || event.shiftKey || event.button !== 0) return;
      event.preventDefault();
      go(to);
    },
  };
}
