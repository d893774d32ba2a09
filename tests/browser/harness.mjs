// SPDX-License-Identifier: GPL-3.0-or-later
// A server with its own data folder, a browser, and TAP.
import { spawn } from 'node:child_process';
import { mkdtemp, readFile, rm } from 'node:fs/promises';
import { createRequire } from 'node:module';
import { tmpdir } from 'node:os';
import { join } from 'node:path';

const { EASEOFF = './easeoff', PAGE, MODULES, CHROMIUM } = process.env;
export const load = createRequire(join(MODULES ?? '.', 'package.json'));

let count = 0;
let failed = 0;

export function ok(condition, what) {
  count += 1;
  if (!condition) failed += 1;
  console.log(`${condition ? 'ok' : 'not ok'} ${count} - ${what}`);
  return Boolean(condition);
}

/** Waits for what is to come, which is a check of its own; what follows in the chapter needs it. */
export async function comes(wait, what) {
  const fault = await wait.then(
    () => null,
    error => error,
  );
  if (!ok(!fault, what)) throw fault;
}

export function note(text) {
  console.log(`# ${text}`);
}

/**
 * A chapter of the story; what goes wrong in it is a failure of its own and does not end the others. EASEOFF_CHAPTER
 * names, as a pattern, those that are run.
 */
export async function chapter(name, act) {
  if (!new RegExp(process.env.EASEOFF_CHAPTER ?? '').test(name)) return;
  const start = performance.now();
  try {
    await act();
  } catch (error) {
    ok(false, `${name}: ${String(error.message).split('\n')[0]}`);
    for (const line of String(error.stack).split('\n').slice(1, 4)) note(line.trim());
  }
  note(`${name}: ${((performance.now() - start) / 1000).toFixed(1)} s`);
}

export function finish() {
  console.log(`1..${count}`);
  process.exitCode = failed ? 1 : 0;
}

/** ms that a page may take for anything: on busy cores a preparation takes ten times as long as on idle ones. */
export const WAIT = Number(process.env.EASEOFF_WAIT ?? 120000);

/** A page of somebody who has been here before, without movement; `troubles`: what its scripts complained about. */
export async function knownPage(browser, options) {
  const context = await browser.newContext({ reducedMotion: 'reduce', ...options });
  await context.addInitScript(() => {
    if (location.protocol === 'http:') localStorage.setItem('easeoff-lead', 'away');
  });
  const page = await context.newPage();
  page.setDefaultTimeout(WAIT);
  const troubles = [];
  page.on('pageerror', error => troubles.push(error.message));
  return { page, troubles };
}

/** Settings with which a pair is prepared in a moment; as an address has them. */
export const COARSE = {
  positions: 16,
  cells_per_line: 6,
  sector_teeth: 3,
  neighbour_coupling: false,
  layers: 6,
  flank_rows: 4,
  fillet_elements: 6,
  harmonics: 6,
  te_harmonics: 6,
};
export const LOOSE = Object.entries(COARSE)
  .map(([key, value]) => `resolution.${key}=${value}`)
  .join('&');

/** Numbers stand at the top of a page, and nothing is being prepared. */
export function settled(page) {
  return page.waitForFunction(
    () => {
      const values = [...document.querySelectorAll('.number-cell .value')];
      const known = values.length > 0 && values.every(value => /\d/.test(value.textContent));
      return known && !document.querySelector('.preparing');
    },
    null,
    { polling: 100 }, // a page behind another one has no frames
  );
}

/** What axe-core finds on a page, one line each. */
export async function findings(page) {
  if (!(await page.evaluate(() => 'axe' in window)))
    await page.evaluate(await readFile(load.resolve('axe-core/axe.min.js'), 'utf8'));
  const { violations } = await page.evaluate(() => window.axe.run(document, { resultTypes: ['violations'] }));
  return violations.map(({ id, nodes }) => {
    const places = nodes.slice(0, 3).map(node => node.target.join(' '));
    return `${id}: ${places.join(' | ')} ${nodes[0].failureSummary.split('\n')[1] ?? ''}`;
  });
}

/** Nothing is found by axe-core, light and dark. */
export async function accessible(page, what) {
  for (const colorScheme of ['light', 'dark']) {
    await page.emulateMedia({ colorScheme });
    const texts = await findings(page);
    ok(texts.length === 0, `${what} is accessible, ${colorScheme}`);
    texts.forEach(note);
  }
  await page.emulateMedia({ colorScheme: 'light' });
}

/** Labels whose text does not fit, and what sticks out of the screen. */
export function cutLabels(page) {
  return page.evaluate(() => {
    const labels = 'h1, h2, h3, button, label, legend, th, dt, b, .label, .sub, .key, .chip span, .case-chip, .unit';
    const cut = [...document.querySelectorAll(labels)]
      .filter(each => each.clientWidth && each.scrollWidth > each.clientWidth + 1 && !each.matches('.unseen'))
      .filter(each => getComputedStyle(each).overflowX !== 'visible')
      .map(each => each.textContent);
    const { scrollWidth } = document.documentElement;
    return scrollWidth > innerWidth ? [...cut, `${scrollWidth} px of ${innerWidth}`] : cut;
  });
}

/** Drops files on an element as a hand does. @param files `{ name, text }` or `{ name, base64 }` */
export async function drop(page, selector, files) {
  const transfer = await page.evaluateHandle(given => {
    const data = new DataTransfer();
    for (const { name, text, base64 } of given) {
      const bytes = base64 ? Uint8Array.from(atob(base64), letter => letter.charCodeAt(0)) : text;
      data.items.add(new File([bytes], name));
    }
    return data;
  }, files);
  for (const kind of ['dragenter', 'dragover', 'drop'])
    await page.locator(selector).first().dispatchEvent(kind, { dataTransfer: transfer });
}

export class Server {
  /** @param {Record<string, string>} [environment] */
  static async start(environment = {}) {
    const server = new Server();
    server.environment = environment;
    server.folder = await mkdtemp(join(tmpdir(), 'easeoff-page-'));
    server.port = 0;
    await server.open();
    return server;
  }

  /** Starts it, the second time at the same address. */
  async open() {
    this.process = spawn(
      EASEOFF,
      [
        'serve',
        '--listen',
        `127.0.0.1:${this.port}`,
        '--data',
        this.folder,
        '--web',
        PAGE,
        '--quiet',
        '--threads',
        '2',
      ],
      { stdio: ['ignore', 'pipe', 'inherit'], env: { ...process.env, ...this.environment } },
    );
    this.address = await new Promise((resolve, reject) => {
      let text = '';
      this.process.stdout.on('data', data => {
        text += data;
        const address = /http:\/\/\S+/.exec(text);
        if (address) resolve(address[0]);
      });
      this.process.on('exit', code => reject(new Error(`the server ended with ${code}`)));
    });
    this.port = new URL(this.address).port;
  }

  /** Ends it and waits for that. */
  async close() {
    const ended = new Promise(resolve => this.process.on('exit', resolve));
    this.process.kill('SIGTERM');
    await ended;
  }

  async remove() {
    await this.close();
    await rm(this.folder, { recursive: true, force: true });
  }
}

export function openBrowser() {
  const { chromium } = load('playwright-core');
  return chromium.launch({ executablePath: CHROMIUM, args: ['--no-sandbox', '--enable-unsafe-swiftshader'] });
}
