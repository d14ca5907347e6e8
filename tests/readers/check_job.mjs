// Checks a Kubernetes manifest in YAML against the schema of its kind, and prints it as JSON.
import { readFileSync } from "node:fs";
import * as batch from "kubernetes-models/batch/v1";
import { parse } from "yaml";

const manifest = parse(readFileSync(process.argv[2], "utf8"));
if (manifest.apiVersion !== "batch/v1") throw new Error(`apiVersion ${manifest.apiVersion}`);
new batch[manifest.kind](manifest).validate();
console.log(JSON.stringify(manifest));
