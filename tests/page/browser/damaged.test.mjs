// Pages that are not whole, or not yet.
import assert from "node:assert/strict";
import { readFileSync, writeFileSync } from "node:fs";
import { createServer } from "node:http";
import { join } from "node:path";
import { after, before, test } from "node:test";
import { folder, launch, open } from "./support.mjs";

let browser;
before(async () => {
  browser = await launch();
});
after(() => browser?.close());

test("a page without data, and a damaged one, say so", async () => {
  const { page: empty } = await open(browser, "empty.html");
  assert.match(await empty.locator("#loading-text").textContent(), /holds no scene: write one with radiosity view/);
  await empty.close();
  const whole = readFileSync(join(folder, "pages/small.html"), "utf8");
  const data = whole.indexOf('<script id="radiosity-data"');
  assert.ok(whole.indexOf("DOMContentLoaded") < data, "the program must stand before the data");
  const middle = data + 60000;
  const altered = (text) => whole.slice(0, middle) + text + whole.slice(middle + text.length);
  const cut = /is cut short.* write the page again with radiosity view/;
  const damaged = /data are damaged; write the page again with radiosity view/;
  for (const [name, text, words] of [
    ["altered", altered("AAAAAAAA"), damaged],
    ["not-base64", altered("?"), damaged],
    ["cut-in-data", whole.slice(0, middle), cut],
    ["cut-in-program", whole.slice(0, data - 100000), cut],
  ]) {
    writeFileSync(join(folder, `pages/${name}.html`), text);
    const { page: broken } = await open(browser, `${name}.html`);
    assert.match(await broken.locator("#loading-text").textContent(), words, name);
    assert.equal(await broken.locator("#loading").isVisible(), true);
    assert.equal(await broken.locator("#app").isVisible(), false);
    await broken.close();
  }
});

// The file arrives piece by piece, as a large one does from a slow disk.
test("while a file is read the loading bar is there", async () => {
  const whole = readFileSync(join(folder, "pages/small.html"));
  const begun = whole.indexOf('<script id="radiosity-data"') + 60000;
  let rest;
  const server = createServer((_, answer) => {
    answer.writeHead(200, { "content-type": "text/html" });
    answer.write(whole.subarray(0, begun));
    rest = () => answer.end(whole.subarray(begun));
  });
  await new Promise((listening) => server.listen(0, "127.0.0.1", listening));
  const slow = await browser.newPage();
  await slow.goto(`http://127.0.0.1:${server.address().port}/`, { waitUntil: "commit" });
  await slow.locator("#loading-text", { hasText: "Reading the page" }).waitFor();
  // Without a value it moves by itself.
  assert.equal(await slow.locator("#loading-bar").getAttribute("value"), null);
  assert.equal(await slow.locator("#loading.failed").count(), 0);
  rest();
  await slow.waitForFunction(() => document.documentElement.dataset.ready);
  await slow.close();
  server.close();
});
