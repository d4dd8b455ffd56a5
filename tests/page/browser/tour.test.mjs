// The tour: each step shows what it speaks of, and at its end the page is as it was.
import assert from "node:assert/strict";
import { after, before, test } from "node:test";
import { apart, colours, launch, open } from "./support.mjs";

let browser;
before(async () => {
  browser = await launch();
});
after(() => browser?.close());

const value = (page, id) => page.locator(`#${id}`).inputValue();
const says = (page, words) =>
  page.waitForFunction((words) => document.getElementById("source").textContent.includes(words), words);

test("seven steps from patches to the error, and all as it was", async () => {
  const { page, said } = await open(browser, "small.html");
  await page.keyboard.press("ArrowLeft", { delay: 80 });
  await page.locator("#show").selectOption("irradiance");
  await page.locator("#picture").focus();
  await page.waitForFunction(() => /show=irradiance/.test(location.hash) && /eye=/.test(location.hash));
  const [link, was] = [page.url(), await colours(page)];

  await page.keyboard.press("t");
  const next = page.locator("#tour-next");
  assert.match(await page.locator("#tour-title").textContent(), /^1\. Patches/);
  assert.match(await page.locator("#tour-text").textContent(), /396 patches/);
  assert.equal(await page.locator("#outlines").isChecked(), true);
  assert.equal(await page.locator("#tour-back").isDisabled(), true);
  const pictures = [await colours(page)];
  const then = async (step, show, source) => {
    await next.press("Enter"); // the button has the focus
    assert.equal(await page.locator("#tour").getAttribute("data-step"), step);
    if (source) await says(page, source);
    assert.equal(await value(page, "show"), show);
    assert.notEqual(await page.locator("#tour-equation").textContent(), "");
    await page.waitForTimeout(100);
    pictures.push(await colours(page));
    assert.ok(apart(pictures.at(-1), pictures.at(-2)) > 2, `${step} looks like the step before`);
  };
  await then("factor", "factors");
  assert.notEqual(await value(page, "pick-first"), "");
  await then("hemicube", "factors");
  await then("first", "light", "Jacobi, bounce 1");
  await then("more", "light", "Jacobi, bounce 3");
  await then("solution", "light", "Light as stored");
  await then("error", "difference", "Jacobi, bounce 3");
  await page.locator("#tour-back").press("Enter");
  await says(page, "Light as stored");
  await next.press("Enter");
  await says(page, "Jacobi, bounce 3");
  assert.equal(await next.textContent(), "End");
  await next.press("Enter");

  assert.equal(await page.locator("#tour").isVisible(), false);
  await says(page, "Light as stored");
  assert.equal(await value(page, "pick-first"), "");
  await page.waitForFunction((link) => location.href === link, link);
  assert.ok(apart(await colours(page), was) < 0.5);
  assert.deepEqual(said, []);
  await page.close();
});

test("390 pixels: the tour stands in place of the panels, and leaves the picture free", async () => {
  const { page, said } = await open(browser, "small.html", { viewport: { width: 390, height: 844 }, hasTouch: true });
  await page.locator("#open-tour").tap();
  const [tour, picture] = await Promise.all(["#tour", "#picture"].map((id) => page.locator(id).boundingBox()));
  assert.ok(tour.y >= picture.y + picture.height && tour.x >= 0 && tour.x + tour.width <= 390);
  assert.ok(await page.evaluate(() => document.documentElement.scrollWidth <= 390));
  await page.locator("#tour-close").tap();
  assert.equal(await page.locator("#tour").isVisible(), false);
  assert.deepEqual(said, []);
  await page.close();
});

test("the tour is offered on the first visit alone, and never forced", async () => {
  const { page, said } = await open(browser, "small.html", {}, "", false);
  const offer = page.locator("#tour-offer");
  assert.ok(await offer.isVisible());
  assert.equal(await page.evaluate(() => document.activeElement === document.body), true);
  await page.locator("#tour-offer-no").click();
  assert.ok(await offer.isHidden());
  assert.ok(await page.locator("#tour").isHidden());
  await page.reload();
  await page.waitForFunction(() => document.documentElement.dataset.ready);
  assert.ok(await offer.isHidden());

  await page.evaluate(() => localStorage.clear());
  await page.reload();
  await page.waitForFunction(() => document.documentElement.dataset.ready);
  await page.locator("#tour-offer-yes").click();
  assert.ok(await offer.isHidden());
  assert.ok(await page.locator("#tour").isVisible());
  assert.deepEqual(said, []);
  await page.close();
});

test("where the browser keeps no notes, and where a link asks for a view, no tour is offered", async () => {
  const { page: linked } = await open(browser, "small.html", {}, "#show=irradiance", false);
  assert.ok(await linked.locator("#tour-offer").isHidden());
  await linked.close();
  const page = await browser.newPage();
  const said = [];
  page.on("pageerror", (error) => said.push(error.message));
  await page.addInitScript(() => {
    Object.defineProperty(window, "localStorage", { get() { throw new DOMException("no", "SecurityError"); } });
  });
  await page.goto(linked.url().split("#")[0]);
  await page.waitForFunction(() => document.documentElement.dataset.ready);
  assert.ok(await page.locator("#tour-offer").isHidden());
  assert.deepEqual(said, []);
  await page.close();
});
