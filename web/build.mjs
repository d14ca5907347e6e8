// Builds dist/page.html, the page in one file, from src/. With --check looks for type errors and
// compares instead of writing.
import { spawnSync } from "node:child_process";
import { existsSync, readFileSync, writeFileSync } from "node:fs";

const here = new URL(".", import.meta.url);
if (!existsSync(new URL("node_modules/esbuild", here))) {
  console.log("SKIPPED, npm install in web/ has not been run");
  process.exit(0);
}
const { build } = await import("esbuild");
const read = (name) => readFileSync(new URL(name, here), "utf8");

const bundle = async (entry) => {
  const built = await build({
    entryPoints: [new URL(entry, here).pathname],
    absWorkingDir: here.pathname,
    bundle: true,
    minify: true,
    write: false,
    target: "es2022",
    charset: "ascii",
    legalComments: "none",
  });
  return built.outputFiles[0].text.trim();
};

const script = (await bundle("src/main.ts")).replaceAll("</script", "<\\/script");
const style = await bundle("src/style.css");
const licence = read("node_modules/uplot/LICENSE").trim();
const page = `<!doctype html>
<!-- Proofmass, Apache-2.0. Built from web/src by web/build.mjs. It contains uPlot:
${licence}
-->
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<link rel="icon" href="data:,">
<title>Proofmass</title>
<style>${style}</style>
</head>
<body>
<div id="app"></div>
<noscript>This page needs JavaScript.</noscript>
<script>${script}</script>
</body>
</html>
`;

const target = new URL("dist/page.html", here);
if (process.argv.includes("--check")) {
  const types = spawnSync("node_modules/.bin/tsc", ["--noEmit", "-p", "."], { cwd: here.pathname, encoding: "utf8" });
  if (types.status !== 0) {
    console.error(types.stdout);
    process.exit(1);
  }
  if (read("dist/page.html") !== page) {
    console.error("web/dist/page.html is not what web/src builds: run npm run build in web/");
    process.exit(1);
  }
} else {
  writeFileSync(target, page);
}
