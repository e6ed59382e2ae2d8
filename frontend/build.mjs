// Builds the replay's page into the Python package: node build.mjs [FOLDER]
import { createHash } from "node:crypto";
import { copyFileSync, mkdirSync, readFileSync, readdirSync, writeFileSync } from "node:fs";
import { dirname, join } from "node:path";
import { fileURLToPath } from "node:url";
import { build } from "esbuild";

const here = dirname(fileURLToPath(import.meta.url));
const out = process.argv[2] ?? join(here, "../src/tmpud/viewer/page");

/** Everything that decides what is built, by its path from this folder. */
const sources = ["build.mjs", "package-lock.json", "package.json", "tsconfig.json"].concat(
  readdirSync(join(here, "src")).map((name) => `src/${name}`),
);

function digest() {
  const hash = createHash("sha256");
  for (const name of sources.sort()) hash.update(`${name}\0`).update(readFileSync(join(here, name))).update("\0");
  return hash.digest("hex");
}

const banner = `/* Built from frontend/ by "make page"; sources sha256 ${digest()} */`;
const result = await build({
  absWorkingDir: here,
  entryPoints: [
    { in: "src/main.ts", out: "replay" },
    { in: "src/style.css", out: "replay" },
  ],
  outdir: out,
  bundle: true,
  minify: true,
  charset: "ascii",
  target: ["es2022"],
  format: "iife",
  write: false,
  logLevel: "warning",
});

mkdirSync(out, { recursive: true });
for (const file of result.outputFiles) {
  if (/<\/(script|style)|\{\{/i.test(file.text)) throw new Error(`${file.path} would end its own element`);
  writeFileSync(file.path, `${banner}\n${file.text}`);
}
copyFileSync(join(here, "src/page.html"), join(out, "replay.html"));
