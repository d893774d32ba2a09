// SPDX-License-Identifier: GPL-3.0-or-later
// Bundles the page into a folder: node build.mjs [FOLDER] (default: dist beside this file).
import { build } from 'esbuild';
import { cp, mkdir, readdir, rm } from 'node:fs/promises';
import { dirname, join, resolve } from 'node:path';
import { fileURLToPath } from 'node:url';

const here = dirname(fileURLToPath(import.meta.url));
const target = resolve(process.argv[2] ?? join(here, 'dist'));

await mkdir(target, { recursive: true });
for (const name of await readdir(target)) {
  if (/\.(js|css|html|svg)$/.test(name)) await rm(join(target, name));
}
await build({
  absWorkingDir: here,
  entryPoints: [
    { in: 'src/main.js', out: 'page' },
    { in: 'src/style.css', out: 'page' },
  ],
  outdir: target,
  bundle: true,
  splitting: true, // views and dialogs are loaded when they are first opened
  format: 'esm',
  target: 'es2022',
  minify: true,
  legalComments: 'eof',
  logLevel: 'warning',
});
for (const name of ['index.html', 'icon.svg']) await cp(join(here, 'src', name), join(target, name));
