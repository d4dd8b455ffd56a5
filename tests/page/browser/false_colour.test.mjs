// False colours: their range, their map, and what the legend says of them.
import assert from "node:assert/strict";
import { after, before, test } from "node:test";
import { launch, module, open, style } from "./support.mjs";

let browser, page, said;
before(async () => {
  browser = await launch();
  ({ page, said } = await open(browser, "small.html"));
});
after(() => browser?.close());

test("the automatic range ends at the 98th percentile, and 0 is in the middle of differences", async () => {
  const { automaticRange, extremes, NO_VALUE } = await module("false_colour");
  const values = Float32Array.from({ length: 101 }, (_, k) => (k < 99 ? k : 1000));
  assert.deepEqual(automaticRange(values, "rising"), { low: 0, high: 98 });
  assert.deepEqual(extremes(values, "rising"), { low: 0, high: 1000 });
  assert.deepEqual(automaticRange(Float32Array.from([0, 0, 0.5, 1, 2]), "logarithmic"), { low: 0.5, high: 1 });
  assert.deepEqual(automaticRange(Float32Array.from([-3, -1, 1, 1]), "diverging"), { low: -1, high: 1 });
  assert.deepEqual(automaticRange(Float32Array.from([0.5, 0.75, 1, 1, NO_VALUE]), "fitted"), { low: 0.5, high: 1 });
  assert.deepEqual(automaticRange(Float32Array.from([0, 0, 0, 3]), "rising"), { low: 0, high: 3 }, "few are not 0");
  for (const scale of ["rising", "fitted", "logarithmic", "diverging"]) {
    const { low, high } = automaticRange(Float32Array.from([NO_VALUE]), scale);
    assert.ok(high > low, scale);
  }
});

test("the legend says what lies beyond its end; differences have blue and red and no logarithm", async () => {
  const ticks = () => page.locator("#legend-ticks span").allTextContents();
  await page.locator("#show").selectOption("radiosity");
  const [first, ...more] = await ticks();
  assert.equal(first, "0");
  assert.match(more.at(-1), /^≥ /);
  // An iterate of half the bounces lacks light: below the solution everywhere.
  await page.locator("#show").selectOption("difference");
  await page.locator("#picture").focus();
  await page.keyboard.press(".");
  await page.waitForFunction(() => /sweep 0/.test(document.getElementById("source").textContent));
  const range = (await ticks()).map((tick) => Number(tick.replace(/[≤≥] /, "").replace("−", "-")));
  assert.equal(range[2], 0);
  assert.equal(range[0], -range[4]);
  assert.equal(await page.locator("#logarithmic").isVisible(), false);
  assert.equal(await page.locator("#range-low").isDisabled(), true);
  const bar = (await style(page, "#legend-bar", "backgroundImage")).match(/rgb\([^)]*\)/g);
  const [blue, middle, red] = [bar[0], bar[8], bar[16]].map((colour) => colour.match(/\d+/g).map(Number));
  assert.ok(blue[2] > 2 * blue[0] && red[0] > 2 * red[2] && Math.min(...middle) > 240, `${bar}`);
});

test("names of options are shown whole", async () => {
  await page.evaluate(() => {
    for (const panel of document.querySelectorAll("details")) panel.open = true;
  });
  for (const width of [1280, 390]) {
    await page.setViewportSize({ width, height: 844 });
    const cut = await page.locator("#app select").evaluateAll((all) =>
      all.flatMap((select) => {
        const style = getComputedStyle(select);
        const context = document.createElement("canvas").getContext("2d");
        context.font = style.font;
        const padding = parseFloat(style.paddingLeft) + parseFloat(style.paddingRight);
        const room = select.clientWidth - padding - 20; // its arrow
        return [...select.options].map((o) => o.text).filter((text) => context.measureText(text).width > room);
      }),
    );
    assert.deepEqual(cut, [], `${width} pixels`);
  }
});

test("the console stayed empty", () => assert.deepEqual(said, []));
