// What a visitor may do at once: keys without a click, clicks that only look, walls that stop, a way back.
import assert from "node:assert/strict";
import { after, before, beforeEach, test } from "node:test";
import { launch, open, pageData } from "./support.mjs";

let browser, page, said;
before(async () => {
  browser = await launch();
});
beforeEach(async () => {
  await page?.close();
  ({ page, said } = await open(browser, "small.html", { viewport: { width: 800, height: 500 } }));
});
after(() => browser?.close());

const camera = () => page.locator("#camera-text").textContent();
const eye = async () => (await camera()).match(/eye=([^;]+)/)[1].split(",").map(Number);

test("arrows, + and W move the view of a page that was only opened", async () => {
  for (const key of ["ArrowLeft", "+", "-", "w"]) {
    const was = await camera();
    await page.keyboard.press(key, { delay: 60 });
    assert.notEqual(await camera(), was, key);
  }
  // Keys are the control's that has the focus.
  await page.locator("#exposure").focus();
  const was = await camera();
  await page.keyboard.press("ArrowLeft", { delay: 60 });
  await page.keyboard.press("w", { delay: 60 });
  assert.equal(await camera(), was);
  assert.deepEqual(said, []);
});

test("a click picks a patch in Inspect alone; I opens and closes it", async () => {
  const picked = () => page.locator("#pick-first").inputValue();
  const picture = page.locator("#picture");
  await picture.click({ position: { x: 230, y: 150 } });
  assert.equal(await picked(), "");
  assert.equal(await page.locator("#patch-panel").getAttribute("open"), null);
  await page.keyboard.press("i");
  await picture.click({ position: { x: 230, y: 150 } });
  assert.notEqual(await picked(), "");
  await page.keyboard.press("i");
  const was = await picked();
  await picture.click({ position: { x: 100, y: 250 } });
  assert.equal(await picked(), was);
});

test("G opens its panel, and so does the space bar", async () => {
  await page.keyboard.press("g");
  assert.equal(await page.locator("#gather-start").isVisible(), true);
  assert.equal(await page.locator("#gather-start").textContent(), "Pause");
  await page.keyboard.press("Space");
  assert.equal(await page.locator("#play").isVisible(), true);
});

// The box is open towards the first view; a walker comes in, and is stopped 2% of the diagonal from what is ahead.
test("a walker is stopped by walls and by the floor, and goes along them", async () => {
  const { position, header } = await pageData("small.html");
  const axis = (k) => [...position].filter((_, at) => at % 3 === k).map((x) => x + header.origin[k]);
  const low = [0, 1, 2].map((k) => Math.min(...axis(k))), high = [0, 1, 2].map((k) => Math.max(...axis(k)));
  const clearance = 0.02 * header.diagonal;
  const inside = (at) => at.every((x, k) => x >= low[k] && x <= high[k]);
  assert.equal(inside(await eye()), false, "the first view is from outside");
  await page.keyboard.press("v");
  await page.keyboard.press("e", { delay: 200 }); // above the boxes
  const box = await page.locator("#picture").boundingBox();
  await page.mouse.move(box.x + 200, box.y + 200);
  for (let k = 0; k < 60; ++k) await page.mouse.wheel(0, -400);
  await page.waitForFunction(() => !document.getElementById("picture").hasAttribute("data-moving"));
  let at = await eye();
  assert.ok(inside(at), `in the box: ${at}`);
  const depth = [0, 1, 2].find((k) => Math.abs(at[k] - low[k]) < 1.01 * clearance ||
    Math.abs(high[k] - at[k]) < 1.01 * clearance);
  assert.notEqual(depth, undefined, `at its wall: ${at}`);
  const along = await eye();
  await page.keyboard.press("d", { delay: 200 });
  assert.ok(Math.hypot(...(await eye()).map((x, k) => x - along[k])) > clearance, "along the wall");
  await page.keyboard.press("q", { delay: 3000 });
  at = await eye();
  assert.ok(inside(at), `above the floor or a box: ${at}`);
  assert.deepEqual(said, []);
});

test("where no light is in view the first view is offered", async () => {
  const lost = page.locator("#lost");
  const first = await camera();
  assert.equal(await lost.isVisible(), false);
  await page.keyboard.press("ArrowRight", { delay: 300 });
  await page.waitForTimeout(500);
  assert.equal(await lost.isVisible(), false);
  await page.keyboard.press("v");
  await page.keyboard.press("ArrowRight", { delay: 1800 }); // the walker, in front of the box, turns away from it
  await lost.waitFor();
  await lost.click();
  await lost.waitFor({ state: "hidden" });
  assert.equal(await camera(), first);
  assert.deepEqual(said, []);
});
