// What a visitor takes away: a link that shows the same, pictures, the command that draws the same.
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { after, before, test } from "node:test";
import { apart, colours, commandPicture, launch, open, pixels, saved, visited } from "./support.mjs";

let browser;
before(async () => {
  browser = await launch();
});
after(() => browser?.close());

const wide = { viewport: { width: 940, height: 658 } };
const slider = (page, name, what = "reflectance") => page.locator(`.relight[data-name="${name}"]:has([aria-label$="${what}"]) input[type=range]`);
const set = (locator, value) =>
  locator.evaluate((control, to) => {
    control.value = String(to);
    for (const event of ["input", "change"]) control.dispatchEvent(new Event(event, { bubbles: true }));
  }, value);
const solved = (page) =>
  page.waitForFunction(() => document.getElementById("relight-facts").dataset.state === "solved");
const unfold = (page) => page.evaluate(() => document.getElementById("share-panel").setAttribute("open", ""));

test("a link restores the view, sliders, picks and looks", async () => {
  const { page, said } = await open(browser, "small.html", wide);
  assert.doesNotMatch(page.url(), /#/);
  await page.keyboard.press("ArrowLeft", { delay: 80 });
  await page.locator("#show").selectOption("irradiance");
  await set(page.locator("#exposure"), 1);
  await set(slider(page, "white"), 0.4);
  await set(slider(page, "light", "strength"), 30);
  await set(page.locator("#pick-first"), 77);
  await page.evaluate(() => document.querySelector('input[name="surfaces"][value="flat"]').click());
  await solved(page);
  await page.waitForFunction(() => /first=77/.test(location.hash) && /flat/.test(location.hash));
  const link = page.url();
  const state = async (where) => [
    await where.locator("#camera-text").textContent(),
    await where.locator("#show").inputValue(),
    await where.locator("#exposure-text").textContent(),
    await where.locator("#pick-first").inputValue(),
    await where.locator("#command").textContent(),
  ];
  const picture = await colours(page);
  const before = await state(page);

  // In a new tab, and in one that has the page already.
  for (const from of ["about:blank", link.split("#")[0]]) {
    const other = await browser.newPage({ ...wide, reducedMotion: "reduce" });
    await visited(other);
    await other.goto(from);
    if (from !== "about:blank") await other.waitForFunction(() => document.documentElement.dataset.ready);
    await other.goto(link);
    await other.waitForFunction(() => document.documentElement.dataset.ready);
    await solved(other);
    await other.waitForFunction(() => document.querySelector('[data-pick="first"]'));
    await other.waitForTimeout(100);
    assert.deepEqual(await state(other), before);
    assert.ok(apart(await colours(other), picture) < 0.5);
    await other.close();
  }

  // Back to the first state, the address has no fragment.
  await page.goto(link.split("#")[0] + "#");
  await page.waitForFunction(() => location.hash === "");
  assert.equal(await page.locator("#source").textContent(), "Light as stored");
  assert.equal(await page.locator("#pick-first").inputValue(), "");
  // What this page lacks is named.
  await page.goto(`${link.split("#")[0]}#reflectance:velvet=.5,.5,.5&eye=1,2`);
  await unfold(page);
  await page.locator("#link-note").waitFor();
  assert.match(await page.locator("#link-note").textContent(), /reflectance:velvet/);
  assert.deepEqual(said, []);
  await page.close();
});

// As in the test of the picture against that of render: 6 of 255, for other anti-aliasing.
test("the command draws the picture that the page saves; the poster has twice its size", async () => {
  for (const change of [null, 0.3]) {
    const { page, said } = await open(browser, "cornell.html", wide);
    await page.keyboard.press("ArrowLeft", { delay: 80 });
    if (change !== null) {
      await set(slider(page, "white"), change);
      await solved(page);
    }
    await set(page.locator("#exposure"), 2.1);
    await unfold(page);
    await page.waitForTimeout(400);
    const mine = pixels(await saved(page, "#save-picture"));
    const [theirs, words] = await commandPicture(page, "command.png");
    const pairs = pixels(theirs).map((p, k) => [p, mine[k]]).filter(([p, m]) => p[3] === 255 && m[3] === 255);
    assert.ok(pairs.length > 60, `${pairs.length} points`);
    const difference = apart(pairs.flatMap(([p]) => p.slice(0, 3)), pairs.flatMap(([, m]) => m.slice(0, 3)));
    assert.ok(difference < 6, `${words}: root mean square ${difference} of 255`);
    const size = (file) =>
      JSON.parse(execFileSync("/usr/bin/python3",
        ["-c", "import sys; from PIL import Image; print(list(Image.open(sys.argv[1]).size))", file]));
    const [width, height] = size(theirs);
    assert.deepEqual(size(await saved(page, "#save-poster")), [2 * width, 2 * height]);
    assert.deepEqual(said, []);
    await page.close();
  }
});

test("full screen shows the picture alone, and its legend", async () => {
  const { page, said } = await open(browser, "small.html", wide);
  await page.locator("#show").selectOption("radiosity");
  await unfold(page);
  await page.locator("#full-screen").click();
  await page.waitForFunction(() => document.fullscreenElement?.id === "app");
  assert.equal(await page.locator("#panels").isVisible(), false);
  assert.equal(await page.locator("#legend").isVisible(), true);
  await page.evaluate(() => document.exitFullscreen());
  await page.locator("#panels").waitFor();
  assert.deepEqual(said, []);
  await page.close();
});
