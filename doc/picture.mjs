// SPDX-License-Identifier: GPL-3.0-or-later
// The picture of the page at the head of README.md, taken in Chromium from a server with a folder of its own: `make figures` writes it.
// The same program and the same fonts give the same bytes: what a clock decides is left out.
import { Server, openBrowser, settled } from '../tests/browser/harness.mjs';

const [, , file] = process.argv;
const server = await Server.start();
const browser = await openBrowser();
try {
  const page = await browser.newPage({ viewport: { width: 1280, height: 800 }, reducedMotion: 'reduce', locale: 'en-GB' });
  page.setDefaultTimeout(600000);
  await page.goto(server.address);
  await settled(page);
  await page.waitForFunction(
    () => {
      const text = selector => document.querySelector(selector)?.textContent ?? '';
      const parts = [...document.querySelectorAll('.sensitivity b')].map(each => each.textContent ?? '');
      return /S_H/.test(text('.capacity')) && parts.length > 0 && parts.every(each => /\d … \d/.test(each));
    },
    null,
    { polling: 200 },
  );
  // how long the last answer took
  await page.evaluate(() => document.querySelectorAll('span.state').forEach(each => (each.style.visibility = 'hidden')));
  await page.mouse.move(1, 1);
  await page.evaluate(() => document.fonts.ready);
  await page.waitForTimeout(1000);
  await page.screenshot({ path: file, animations: 'disabled', caret: 'hide' });
} finally {
  await browser.close();
  await server.remove();
}
