// The page's controls by keyboard, on other keyboards' layouts, by mouse and by touch; narrow and with high contrast.
import assert from "node:assert/strict";
import { after, before, test } from "node:test";
import { launch, open, style } from "./support.mjs";

let browser, page, said; // a page that the tests share
before(async () => {
  browser = await launch();
  ({ page, said } = await open(browser, "small.html", { viewport: { width: 800, height: 500 } }));
});
after(() => browser?.close());

const unfoldAll = (page) =>
  page.evaluate(() => {
    for (const panel of document.querySelectorAll("details")) panel.open = true;
  });
const text = (page, id) => page.locator(`#${id}`).textContent();

/** From the eye to the point about which it turns. */
async function distance(page) {
  const words = (await text(page, "camera-text")).match(/=[^;]+/g);
  const [eye, target] = words.map((word) => word.slice(1).split(",").map(Number));
  return Math.hypot(...eye.map((x, k) => x - target[k]));
}

/** What a key does to a control with a value: the value, or the state of a check box, before and after. */
async function turned(page, control, key) {
  const value = () => control.evaluate((e) => (e.type === "checkbox" || e.type === "radio" ? e.checked : e.value));
  await control.focus();
  const was = await value();
  await page.keyboard.press(key);
  return [was, await value()];
}

test("a press of the mouse draws no ring and no crosshair on the picture, a key does", async () => {
  const shown = () =>
    page.evaluate(() => [
      getComputedStyle(document.getElementById("picture")).outlineStyle !== "none",
      getComputedStyle(document.getElementById("crosshair")).display !== "none",
    ]);
  await page.locator("#picture").click({ modifiers: ["Shift"] });
  assert.equal(await page.evaluate(() => document.activeElement.id), "picture");
  assert.deepEqual(await shown(), [false, false]);
  await page.keyboard.press("ArrowLeft");
  assert.deepEqual(await shown(), [true, true]);
  await page.keyboard.press("Escape");
  await page.keyboard.press("r");
});

test("every button does its work by the Enter key", async () => {
  const enter = async (selector) => {
    await page.locator(selector).focus();
    await page.keyboard.press("Enter");
  };
  const says = (id, words) =>
    page.waitForFunction(([id, words]) => document.getElementById(id).textContent.includes(words), [id, words]);
  for (const panel of await page.locator("details").all()) {
    const is = () => panel.evaluate((e) => e.open);
    const was = await is();
    await panel.locator("summary").focus();
    await page.keyboard.press("Enter");
    assert.equal(await is(), !was);
  }
  await unfoldAll(page);
  const view = await text(page, "camera-text");
  await page.locator("#picture").press("ArrowLeft", { delay: 60 });
  assert.notEqual(await text(page, "camera-text"), view);
  await enter("#reset-view");
  assert.equal(await text(page, "camera-text"), view);
  await enter("#open-help");
  assert.equal(await page.locator("#help").isVisible(), true);
  await enter("#close-help");
  assert.equal(await page.locator("#help").isVisible(), false);

  await page.locator("#picture").press("Enter");
  await page.locator('[data-pick="first"]').waitFor();
  await enter("#pick-clear");
  assert.equal(await page.locator('[data-pick="first"]').count(), 0);

  await enter("#step");
  await says("iteration-text", "sweep 0");
  await enter("#step");
  await says("iteration-text", "sweep 1");
  await enter("#play");
  await says("play", "Pause");
  await enter("#play");
  await says("play", "Play");
  const [was, is] = await turned(page, page.locator("#iteration"), "ArrowLeft");
  assert.equal(Number(is), Number(was) - 1);
  await enter("#restart");
  await says("iteration-text", "sweep 0");
  await enter("#to-stored");
  await says("source", "Light as stored");

  await page.locator("#show").selectOption("radiosity");
  await page.locator("#range-high").fill("0.5");
  await page.locator("#range-high").press("Tab");
  assert.match(await text(page, "legend-ticks"), /0\.5$/);
  await enter("#range-auto");
  assert.doesNotMatch(await text(page, "legend-ticks"), /0\.5$/);

  await page.locator('.relight[data-name="white"] input[type=range]').press("PageDown");
  await says("source", "Relit");
  for (const id of ["copy-command", "copy-camera"]) {
    await enter(`#${id}`);
    await page.waitForFunction((id) => document.getElementById(id).textContent !== "Copy", id);
  }
  await enter('.relight[data-name="white"] button');
  assert.equal(await page.locator("#relight-reset").isDisabled(), true);
  await page.locator('.relight[data-name="white"] input[type=range]').press("PageDown");
  await enter("#relight-reset");
  await says("source", "Light as stored");

  await enter("#gather-start");
  await says("gather-start", "Pause");
  await enter("#gather-reset");
  await says("gather-start", "Start");
  assert.deepEqual(said, []);
});

test("a click beside the scene clears both picks; with Shift the second", async () => {
  const picks = () => Promise.all(["#pick-first", "#pick-second"].map((id) => page.locator(id).inputValue()));
  const box = await page.locator("#picture").boundingBox();
  const click = async (x, y, shift) => {
    if (shift) await page.keyboard.down("Shift");
    await page.mouse.click(box.x + box.width * x, box.y + box.height * y);
    if (shift) await page.keyboard.up("Shift");
  };
  await click(0.5, 0.35, false);
  await click(0.2, 0.3, true);
  assert.ok((await picks()).every((pick) => pick !== ""));
  await click(0.01, 0.5, true);
  assert.deepEqual((await picks()).map((pick) => pick !== ""), [true, false]);
  await click(0.2, 0.3, true);
  await click(0.01, 0.5, false);
  assert.deepEqual(await picks(), ["", ""]);
});

/** A press of a key as a keyboard of another layout gives it. */
const pressAs = (page, init) =>
  page.evaluate(async (init) => {
    const canvas = document.getElementById("picture");
    canvas.focus();
    canvas.dispatchEvent(new KeyboardEvent("keydown", { bubbles: true, cancelable: true, ...init }));
    await new Promise((resume) => setTimeout(resume, 60));
    canvas.dispatchEvent(new KeyboardEvent("keyup", { bubbles: true, ...init }));
  }, init);

test("plus, minus and brackets are where the keyboard's layout has them", async () => {
  const eye = () => text(page, "camera-text");
  const first = await distance(page);
  await pressAs(page, { key: "+", code: "BracketRight" }); // German
  const near = await distance(page);
  assert.ok(near < first);
  await pressAs(page, { key: "-", code: "Slash" });
  assert.ok((await distance(page)) > near);
  const still = await eye();
  await pressAs(page, { key: "ß", code: "Minus" });
  await pressAs(page, { key: "´", code: "Equal" });
  assert.equal(await eye(), still);
  // AltGr is Ctrl and Alt in Windows.
  const exposure = await page.locator("#exposure").inputValue();
  const altGr = { ctrlKey: true, altKey: true, modifierAltGraph: true };
  await pressAs(page, { key: "]", code: "Digit9", ...altGr });
  assert.ok(Number(await page.locator("#exposure").inputValue()) > Number(exposure));
  await pressAs(page, { key: "[", code: "Digit8", ...altGr });
  assert.equal(await page.locator("#exposure").inputValue(), exposure);
  await pressAs(page, { key: "]", code: "BracketRight", ctrlKey: true });
  assert.equal(await page.locator("#exposure").inputValue(), exposure);
});

// Colour fields open the browser's own chooser, which is no part of the page.
test("every control with a value is changed by keys alone", async () => {
  await page.locator("#show").selectOption("radiosity"); // its range has controls too
  await unfoldAll(page);
  await page.locator("#before-after").check(); // the slider of the split
  const controls = await page.locator("#app input:not([type=color]), #app select").all();
  let seen = 0;
  for (const control of controls) {
    if (!(await control.isVisible()) || !(await control.isEnabled())) continue;
    const [name, kind] = await control.evaluate((e) => [e.id || e.getAttribute("aria-label") || e.value, e.type]);
    const keys = { checkbox: ["Space"], "select-one": ["ArrowDown", "ArrowUp"], number: ["7"], radio: ["ArrowRight"] };
    if (name === "iteration") continue; // it has one place until a run has begun; above
    let changed = false;
    for (const key of keys[kind] ?? ["ArrowRight", "ArrowLeft"]) {
      const [was, is] = await turned(page, control, key);
      changed ||= was !== is;
      if (kind === "checkbox") await page.keyboard.press(key); // as it was: others depend on it
    }
    // One button of a group has the keys for all.
    if (kind === "radio" && !changed) continue;
    assert.ok(changed, `${name} (${kind}) must follow its keys`);
    ++seen;
  }
  assert.ok(seen > 20, `${seen} controls`);
  assert.deepEqual(said, []);
});

/** Sends touches of the picture at shares of its width and height. */
async function fingersOn(page) {
  const box = await page.locator("#picture").boundingBox();
  const fingers = await page.context().newCDPSession(page);
  return (type, ...points) =>
    fingers.send("Input.dispatchTouchEvent", {
      type,
      touchPoints: points.map(([x, y], id) => ({ x: box.x + box.width * x, y: box.y + box.height * y, id })),
    });
}

test("fingers: a long press picks the second patch, two zoom", async () => {
  const { page, said } = await open(browser, "small.html", { viewport: { width: 390, height: 844 }, hasTouch: true });
  const touch = await fingersOn(page);
  await page.evaluate(() => document.getElementById("patch-panel").setAttribute("open", ""));
  await touch("touchStart", [0.5, 0.35]);
  await touch("touchEnd");
  await page.locator('[data-pick="first"]').waitFor();
  await touch("touchStart", [0.3, 0.3]);
  await page.waitForTimeout(600);
  await touch("touchEnd");
  await page.locator('[data-pick="second"]').waitFor();

  const first = await distance(page);
  await touch("touchStart", [0.45, 0.5], [0.55, 0.5]);
  for (let k = 1; k <= 4; ++k) await touch("touchMove", [0.45 - 0.05 * k, 0.5], [0.55 + 0.05 * k, 0.5]);
  await touch("touchEnd");
  assert.ok((await distance(page)) < 0.6 * first, `${await distance(page)} of ${first}`);
  assert.deepEqual(said, []);
  await page.close();
});

test("390 pixels: every target of a finger is 44 pixels high and wide", async () => {
  const { page, said } = await open(browser, "small.html", { viewport: { width: 390, height: 844 }, hasTouch: true });
  await unfoldAll(page);
  await page.locator("#show").selectOption("radiosity");
  await page.locator("#before-after").check();
  const small = await page.locator("button, select, input, summary, .check, .choice span").evaluateAll((all) =>
    all.filter((e) => e.checkVisibility() && !(e.type === "checkbox" || e.type === "radio")) // their labels are targets
      .map((e) => [e.id || e.className || e.textContent, e.getBoundingClientRect()])
      .filter(([, { width, height }]) => width < 44 || height < 44)
      .map(([name, { width, height }]) => `${name}: ${width} x ${height}`));
  assert.deepEqual(small, []);
  assert.ok(await page.evaluate(() => document.getElementById("panels").scrollWidth <= 390));
  assert.deepEqual(said, []);
  await page.close();
});

test("two fingers walk: ahead, and no farther than the wall", async () => {
  const { page, said } = await open(browser, "small.html", { viewport: { width: 390, height: 844 }, hasTouch: true });
  const touch = await fingersOn(page);
  const eye = async () => (await text(page, "camera-text")).match(/eye=([^;]+)/)[1].split(",").map(Number);
  const pinch = async () => {
    await touch("touchStart", [0.47, 0.5], [0.53, 0.5]);
    for (let k = 1; k <= 6; ++k) await touch("touchMove", [0.47 - 0.06 * k, 0.5], [0.53 + 0.06 * k, 0.5]);
    await touch("touchEnd");
    return (await eye())[2]; // the box is open at its low z
  };
  await page.evaluate(() => document.querySelector('input[name="move"][value="walk"]').click());
  const places = [(await eye())[2]];
  for (let k = 0; k < 12; ++k) places.push(await pinch());
  assert.ok(places[1] > places[0] + 0.05, `ahead: ${places}`);
  assert.ok(places.every((z, k) => k === 0 || z >= places[k - 1] - 1e-6), `never back: ${places}`);
  assert.ok(Math.abs(places.at(-1) - places.at(-2)) < 1e-3, `it ends at a wall: ${places}`);
  assert.ok(places.at(-1) < 0.56, `within the box: ${places}`);
  assert.deepEqual(said, []);
  await page.close();
});

test("390 pixels: panels fold, nothing is wider than the screen, a touch picks", async () => {
  for (const colorScheme of ["light", "dark"]) {
    const { page: narrow, said: words } = await open(browser, "cornell.html", {
      viewport: { width: 390, height: 844 },
      hasTouch: true,
      colorScheme,
    });
    assert.equal(await narrow.locator("details[open]").count(), 0);
    const box = await narrow.locator("#picture").boundingBox();
    assert.ok(box.width === 390 && box.height > 300);
    await narrow.locator("#patch-panel summary").tap();
    await narrow.touchscreen.tap(box.x + 195, box.y + box.height - 20);
    await narrow.locator('[data-pick="first"]').waitFor();
    await narrow.locator("#legend").waitFor();
    const [legend, picture] = await Promise.all(["#legend", "#picture"].map((id) => narrow.locator(id).boundingBox()));
    assert.deepEqual(picture, box, "the picture must keep its size");
    assert.ok(legend.y >= picture.y + picture.height, "the legend must hide nothing of it");
    await narrow.evaluate(() => {
      for (const panel of document.querySelectorAll("details")) panel.open = true;
    });
    assert.ok(
      await narrow.evaluate(() =>
        [document.documentElement, document.getElementById("panels")].every((e) => e.scrollWidth <= 390),
      ),
    );
    assert.deepEqual(words, []);
    await narrow.close();
  }
});

/** Of WCAG 2.2, of "rgb(...)" on "rgb(...)". */
function contrastOf(text, ground) {
  const luminance = (colour) => {
    const linear = (x) => (x <= 0.04045 ? x / 12.92 : ((x + 0.055) / 1.055) ** 2.4);
    const [r, g, b] = colour.match(/[\d.]+/g).map((x) => linear(x / 255));
    return 0.2126 * r + 0.7152 * g + 0.0722 * b;
  };
  const [low, high] = [luminance(text), luminance(ground)].sort((a, b) => a - b);
  return (high + 0.05) / (low + 0.05);
}

test("high contrast and forced colours: texts, borders and pressed buttons stand out", async () => {
  const { page: contrast, said: words } = await open(browser, "small.html", { contrast: "more" });
  for (const colorScheme of ["light", "dark"]) {
    await contrast.emulateMedia({ contrast: "more", colorScheme });
    const panel = await style(contrast, "#panels", "backgroundColor");
    for (const selector of ["#subtitle", "summary", "#look-panel label", ".note"]) {
      const ratio = contrastOf(await style(contrast, selector, "color"), panel);
      assert.ok(ratio > 15, `${colorScheme}: ${selector} ${ratio}`);
    }
    for (const selector of ["#open-help", "#show", "#panels details"]) {
      const ratio = contrastOf(await style(contrast, selector, "borderBottomColor"), panel);
      assert.ok(ratio > 15, `${colorScheme}: the border of ${selector} ${ratio}`);
    }
    const chosen = await style(contrast, ".choice input:checked + span", "backgroundColor");
    assert.ok(contrastOf(await style(contrast, ".choice input:checked + span", "color"), chosen) > 4.5);
    assert.ok(contrastOf(chosen, panel) > 3, `${colorScheme}: what is chosen`);
  }
  // Forced colours: what is pressed or chosen has the system's colour of selections.
  await contrast.emulateMedia({ contrast: null, forcedColors: "active" });
  await contrast.evaluate(() => {
    document.getElementById("converge-panel").open = true;
  });
  await contrast.locator("#speed").press("Home");
  await contrast.locator("#play").click();
  const highlight = await contrast.evaluate(() => {
    const probe = document.createElement("p");
    probe.style = "background: Highlight; forced-color-adjust: none";
    document.body.append(probe);
    return getComputedStyle(probe).backgroundColor;
  });
  for (const selector of ["#play[aria-pressed=true]", ".choice input:checked + span"]) {
    assert.equal(await style(contrast, selector, "backgroundColor"), highlight, selector);
  }
  assert.notEqual(await style(contrast, "#step", "backgroundColor"), highlight);
  assert.deepEqual(words, []);
  await contrast.close();
});
