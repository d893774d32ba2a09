// SPDX-License-Identifier: GPL-3.0-or-later
// The manuals as pages: node manual.mjs DOC FOLDER. Markdown by marked, equations by KaTeX as MathML: no script, no
// font, nothing from elsewhere.
import katex from 'katex';
import { Marked } from 'marked';
import { cp, mkdir, readFile, readdir, rm, writeFile } from 'node:fs/promises';
import { dirname, join, relative } from 'node:path';

const [source, target] = process.argv.slice(2);
const MANUALS = [
  ['index.md', 'Manuals'],
  ['guide.md', 'User guide'],
  ['api.md', 'API guide'],
  ['cluster.md', 'Studies and clusters'],
  ['theory.md', 'Theory'],
  ['validation.md', 'Validation'],
];

/** @type {Record<string, string>} */
const ENTITY = { '&': '&amp;', '<': '&lt;', '>': '&gt;', '"': '&quot;' };
const escape = (/** @type {string} */ text) => text.replace(/[&<>"]/g, (c) => ENTITY[c]);
const slug = (/** @type {string} */ text) =>
  text
    .toLowerCase()
    .replace(/<[^>]*>|[^\p{L}\p{N} _-]/gu, '')
    .replace(/ /g, '-');

/** `$$ ... \tag{C1} $$`: the equation in the middle, its number at the right, as a place that can be linked to. */
const equation = {
  name: 'equation',
  level: 'block',
  start: (/** @type {string} */ text) => text.indexOf('$$'),
  tokenizer(/** @type {string} */ text) {
    const match = /^\$\$([\s\S]+?)\$\$(?:\n|$)/.exec(text);
    if (!match) return undefined;
    const tag = /\\tag\{(\w+)\}/.exec(match[1])?.[1] ?? '';
    return { type: 'equation', raw: match[0], tag, text: match[1].replace(/\\tag\{\w+\}/, '').trim() };
  },
  renderer(/** @type {{ text: string, tag: string }} */ token) {
    // styles within elements are what the server's pages may not have
    const math = katex
      .renderToString(token.text, { output: 'mathml', displayMode: true, throwOnError: true })
      .replace(/ style="[^"]*"/g, '');
    const number = token.tag ? `<a href="#${token.tag}">(${token.tag})</a>` : '';
    return `<div class="equation"${token.tag ? ` id="${token.tag}"` : ''}>${math}${number}</div>\n`;
  },
};

const marked = new Marked({ extensions: [equation] });
marked.use({
  renderer: {
    heading({ tokens, depth }) {
      const text = this.parser.parseInline(tokens);
      return `<h${depth} id="${slug(text)}">${text}</h${depth}>\n`;
    },
    link({ href, tokens }) {
      const page = href.replace(/\.md(?=#|$)/, '.html');
      return `<a href="${escape(page)}">${this.parser.parseInline(tokens)}</a>`;
    },
    code({ text, lang }) {
      return `<pre${lang ? ` data-kind="${escape(lang.split(' ')[0])}"` : ''}><code>${escape(text)}</code></pre>\n`;
    },
    table(token) {
      const row = (/** @type {string} */ kind, /** @type {any[]} */ cells) =>
        `<tr>${cells.map((cell) => `<${kind}>${this.parser.parseInline(cell.tokens)}</${kind}>`).join('')}</tr>`;
      const head = row('th', token.header);
      const rows = token.rows.map((cells) => row('td', cells)).join('\n');
      return `<div class="table"><table><thead>${head}</thead><tbody>${rows}</tbody></table></div>\n`;
    },
  },
});

/** In what people read, outside code and equations: "(C1)" leads to its equation, and r_b1 has its index below.
 * @param {string} html @param {string} up @param {Map<string, string>} equations */
function finish(html, up, equations) {
  let closed = 0; // inside how many elements whose text stays as it is
  return html.replace(/<(\/?)(\w+)[^>]*>|[^<]+/g, (piece, close, element) => {
    if (element) {
      if (['code', 'pre', 'math', 'a'].includes(element)) closed += close ? -1 : 1;
      return piece;
    }
    if (closed) return piece;
    return piece
      .replace(/\(([A-Z]+\d+)\)/g, (label, name) =>
        equations.has(name) ? `<a href="${up}/${equations.get(name)}#${name}">${label}</a>` : label)
      .replace(/(?<![\w.])([A-Za-z\u0391-\u03c9]{1,2})_([A-Za-z0-9\u0391-\u03c9*]{1,5})(?![\w_])/g, '$1<sub>$2</sub>');
  });
}

/** @param {string} name @param {string} text @param {Map<string, string>} equations */
function pageOf(name, text, equations) {
  const title = /^# (.+)$/m.exec(text)?.[1] ?? name;
  const up = relative(dirname(name), '.') || '.';
  const links = MANUALS.map(([file, label]) => {
    const here = file === name || (file === 'theory.md' && name.startsWith('theory/'));
    return `<a href="${up}/${file.replace('.md', '.html')}"${here ? ' aria-current="page"' : ''}>${label}</a>`;
  });
  const body = finish(String(marked.parse(text.replace(/<!--[\s\S]*?-->\n?/g, ''))), up, equations);
  return `<!doctype html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<meta name="color-scheme" content="light dark">
<title>${escape(title)} – Easeoff</title>
<link rel="icon" href="${up}/../icon.svg" type="image/svg+xml">
<link rel="stylesheet" href="${up}/manual.css">
</head>
<body>
<header><a href="${up}/../">Easeoff</a><nav aria-label="Manuals">${links.join('')}</nav></header>
<main>
${body}</main>
</body>
</html>
`;
}

await rm(target, { recursive: true, force: true });
await mkdir(join(target, 'theory'), { recursive: true });
const chapters = (await readdir(join(source, 'theory')))
  .filter((name) => name.endsWith('.md'))
  .map((name) => `theory/${name}`);
const htmlOf = (/** @type {string} */ name) => name.replace('.md', '.html');
const texts = new Map();
const equations = new Map();
for (const name of [...MANUALS.map(([file]) => file), ...chapters]) {
  texts.set(name, await readFile(join(source, name), 'utf8'));
  for (const [, label] of texts.get(name).matchAll(/\\tag\{(\w+)\}/g)) equations.set(label, htmlOf(name));
}
for (const [name, text] of texts) await writeFile(join(target, htmlOf(name)), pageOf(name, text, equations));
await mkdir(join(target, 'figures'), { recursive: true });
for (const name of await readdir(join(source, 'figures')))
  if (/\.(svg|png)$/.test(name)) await cp(join(source, 'figures', name), join(target, 'figures', name));
await cp(join(source, 'manual.css'), join(target, 'manual.css'));
