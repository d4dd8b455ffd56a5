// Runs as soon as the page's first lines are there, so that a file that is cut short anywhere later is named.
import { fail, isCutShort } from "./failure";

document.addEventListener("DOMContentLoaded", () => {
  if (isCutShort()) fail("This file is cut short; copy it again, or write the page again with radiosity view");
});
