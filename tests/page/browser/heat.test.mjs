// A page of heat: the program's temperatures and fluxes, on patches, by surface, and between two patches.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { join } from "node:path";
import { after, before, test } from "node:test";
import { apart, colours, folder, launch, open, results } from "./support.mjs";

let browser, page, said;
before(async () => {
  browser = await launch();
  ({ page, said } = await open(browser, "heat.html"));
});
after(() => browser?.close());

const near = (x, y) => Math.abs(x - y) <= 1e-6 * Math.abs(y) + 1e-9;

test("temperatures are shown first, with a legend, and each quantity has colours of its own", async () => {
  assert.equal(await page.locator("#show").inputValue(), "temperature");
  assert.match(await page.locator("#legend-title").textContent(), /Temperature, K/);
  const temperature = await colours(page);
  await page.locator("#show").selectOption("net-flux");
  assert.match(await page.locator("#legend-title").textContent(), /Net flux/);
  assert.ok(apart(temperature, await colours(page)) > 15);
  await page.locator("#show").selectOption("temperature");
});

test("the table by surface is that of radiosity heat", async () => {
  const [head, ...lines] = readFileSync(join(folder, "pages/heat.csv"), "utf8").trim().split("\n").map((l) => l.split(","));
  const column = (line, name) => Number(line[head.indexOf(name)]);
  const rows = await page.locator("#heat-surfaces tr").all();
  assert.equal(rows.length, lines.length);
  for (const [k, row] of rows.entries()) {
    assert.equal(await row.locator("th").textContent(), lines[k][0]);
    const shown = await row.locator("data").evaluateAll((cells) => cells.map((c) => Number(c.value)));
    const expected = [column(lines[k], "temperature_K"), column(lines[k], "net_flux_W_per_m2"),
      column(lines[k], "radiated_W") + column(lines[k], "convected_W")];
    shown.forEach((x, c) => assert.ok(near(x, expected[c]), `${lines[k][0]}: ${x}, not ${expected[c]}`));
  }
});

test("a picked patch has its temperature, two have their net exchange A F (J - J')", async () => {
  const truth = results("heat.h5");
  await page.evaluate(() => document.getElementById("patch-panel").setAttribute("open", ""));
  for (const [name, patch] of [["first", 3], ["second", 60]]) {
    await page.locator(`#pick-${name}`).fill(String(patch));
    await page.locator(`#pick-${name}`).press("Enter");
  }
  await page.locator('[data-pick="pair"]').waitFor();
  const value = async (of, label) =>
    Number(await page.locator(`[data-pick="${of}"] dt:text-is("${label}") + dd data`).getAttribute("value"));
  assert.ok(near(await value("first", "Temperature, K"), truth.temperature[3]));
  assert.ok(near(await value("second", "Net flux of heat, W/m²"), truth.net_flux[60]));
  const expected = truth.area[3] * truth.factors[3][60] * (truth.radiosity[3] - truth.radiosity[60]);
  const shown = await value("pair", "Net heat there, W");
  assert.ok(expected !== 0);
  // Form factors have 16 bits: 3e-4.
  assert.ok(Math.abs(shown - expected) <= 3e-4 * Math.abs(expected), `${shown}, not ${expected}`);
  assert.deepEqual(said, []);
});
