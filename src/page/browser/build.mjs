// node build.mjs OUT.html: the page without its data, one file: index.html with style sheet, program
// and worker inside. `radiosity view` replaces the text <!--radiosity-data--> in it. The program comes
// before the data, and waits for their end, so that it can name a file that is cut short.
import { readFile, rename, writeFile } from "node:fs/promises";
import { dirname, join } from "node:path";
import { fileURLToPath } from "node:url";
import { build } from "esbuild";
import { assembled } from "./assemble.mjs";

const here = dirname(fileURLToPath(import.meta.url));
const out = process.argv[2];
if (!out || process.argv.length > 3) {
  console.error("usage: node build.mjs OUT.html");
  process.exit(2);
}

const common = {
  bundle: true,
  minify: true,
  write: false,
  format: "iife",
  target: "es2022",
  charset: "utf8",
  legalComments: "none",
  logLevel: "warning",
};

async function bundled(entry, more = {}) {
  const result = await build({ ...common, entryPoints: [join(here, entry)], ...more });
  return result.outputFiles[0].text;
}

/** Imports of "wat:FILE" are the assembled program of FILE, as bytes. */
const kernels = {
  name: "kernels",
  setup(setup) {
    setup.onResolve({ filter: /^wat:/ }, (found) => ({
      path: found.path.slice("wat:".length),
      namespace: "wat",
    }));
    setup.onLoad({ filter: /.*/, namespace: "wat" }, async (found) => ({
      contents: await assembled(join(here, found.path)),
      loader: "binary",
    }));
  },
};

/** Imports of "worker:FILE" are the bundled program of FILE, as a text. */
const workers = {
  name: "workers",
  setup(setup) {
    setup.onResolve({ filter: /^worker:/ }, (found) => ({
      path: found.path.slice("worker:".length),
      namespace: "worker",
    }));
    setup.onLoad({ filter: /.*/, namespace: "worker" }, async (found) => ({
      contents: await bundled(found.path, { plugins: [kernels] }),
      loader: "text",
    }));
  },
};

/** Escapes text for a script element, so that it does not end the element. */
const inScript = (text) => text.replace(/<\/(script)/gi, "<\\/$1").replace(/<!--/g, "<\\!--");

/** Replaces `mark`, which must occur once, by `text`. */
function put(page, mark, text) {
  if (page.split(mark).length !== 2) throw new Error(`index.html needs ${mark} once`);
  return page.replace(mark, () => text);
}

const style = await bundled("style.css", { loader: { ".css": "css" } });
const reading = await bundled("reading.ts");
const program = await bundled("main.ts", { plugins: [workers] });
const licence = (await readFile(join(here, "THREE-LICENSE.txt"), "utf8")).trim();
let page = await readFile(join(here, "index.html"), "utf8");
page = put(page, "<!--style-->", `<style>${style.trim()}</style>`);
page = put(page, "<!--reading-->", `<script>${inScript(reading.trim())}</script>`);
page = put(page, "<!--program-->", `<script>\n/* three.js: ${licence} */\n${inScript(program)}</script>`);
if (page.split("<!--radiosity-data-->").length !== 2) {
  throw new Error("the page needs <!--radiosity-data--> once");
}
await writeFile(`${out}.new`, page);
await rename(`${out}.new`, out);
