// SPDX-License-Identifier: GPL-3.0-or-later
// Writes what the API asks and answers as types for tsc: node types.mjs EASEOFF FILE. A server of that program, with an
// empty folder and at a free port of this machine, describes itself; nothing of it stays.
import { spawn } from 'node:child_process';
import { mkdtemp, rm, writeFile } from 'node:fs/promises';
import { tmpdir } from 'node:os';
import { join, resolve } from 'node:path';

/** @typedef {Record<string, any>} Schema as OpenAPI 3.1 has it */

const NAME = /^[A-Za-z_$][\w$]*$/;

/** @param {string} key */
const keyOf = key => (NAME.test(key) ? key : JSON.stringify(key));

/** A comment in one line. @param {Schema} schema */
function remark(schema) {
  const unit = schema['x-unit'] ? ` [${schema['x-unit']}]` : '';
  const text = `${schema.description ?? ''}${unit}`.trim().replaceAll('*/', '* /');
  return text ? `/** ${text} */ ` : '';
}

/** @param {Schema} schema @returns {string} */
function typeOf(schema) {
  if (schema.$ref) return schema.$ref.replace(/^.*\//, '');
  if (schema.anyOf) return unionOf(schema.anyOf.map(typeOf));
  if (schema.enum) return unionOf(schema.enum.map((/** @type {unknown} */ value) => JSON.stringify(value)));
  const kinds = [schema.type ?? []].flat();
  return kinds.length ? unionOf(kinds.map(kind => typeOfKind(kind, schema))) : 'unknown';
}

/** @param {string[]} types */
const unionOf = types => [...new Set(types)].join(' | ');

/** @param {string} kind @param {Schema} schema */
function typeOfKind(kind, schema) {
  switch (kind) {
    case 'integer':
    case 'number':
      return 'number';
    case 'array':
      return `Array<${typeOf(schema.items ?? {})}>`;
    case 'object':
      return typeOfObject(schema);
    default:
      return schema.format === 'binary' ? 'Blob' : kind;
  }
}

/** @param {Schema} schema */
function typeOfObject({ properties, required = [], additionalProperties }) {
  if (!properties)
    return `Record<string, ${additionalProperties instanceof Object ? typeOf(additionalProperties) : 'unknown'}>`;
  const rows = Object.entries(properties).map(
    ([key, each]) => `${remark(each)}${keyOf(key)}${required.includes(key) ? '' : '?'}: ${typeOf(each)};`,
  );
  return `{\n${rows.join('\n')}\n}`;
}

/** What a request or an answer holds: JSON or text, or nothing. @param {Schema | undefined} content */
function typeOfContent(content) {
  const one = content?.['application/json'] ?? Object.values(content ?? {})[0];
  return one && typeOf(one.schema);
}

/** The rows of one method: its paths below the base, as templates, with what is asked and what is answered. */
function operationsOf(/** @type {Schema} */ paths, /** @type {string} */ method) {
  const rows = [];
  for (const [path, methods] of Object.entries(paths)) {
    const operation = methods[method];
    if (!operation) continue;
    const answers = Object.entries(operation.responses).filter(([status]) => status.startsWith('2'));
    const place = path.slice(1).replace(/\{\w+\}/g, '${string}');
    const answer = unionOf(answers.map(([, response]) => typeOfContent(response.content) ?? 'null'));
    rows.push({ place, asked: typeOfContent(operation.requestBody?.content) ?? 'Record<string, never>', answer });
  }
  return rows.sort((a, b) => b.place.length - a.place.length); // what begins alike: the longer one first
}

/** @param {Schema} description of GET /openapi.json */
function declarationOf({ components, paths }) {
  const parts = [
    '// Written by types.mjs from what the program says of itself; changes made here are lost.',
    'declare namespace Api {',
  ];
  for (const [name, schema] of Object.entries(components.schemas)) parts.push(`type ${name} = ${typeOf(schema)};`);
  parts.push('/** A path without its query. */ type Path<P> = P extends `${infer Q}?${string}` ? Q : P;');
  for (const method of ['get', 'post', 'put', 'delete', 'patch']) {
    const rows = operationsOf(paths, method);
    for (const part of /** @type {const} */ (['asked', 'answer'])) {
      const chain = rows.map(row => `Q extends \`${row.place}\` ? ${row[part]} :\n`).join('');
      const name = `${method[0].toUpperCase()}${method.slice(1)}${part === 'asked' ? 'Body' : 'Answer'}`;
      parts.push(`type ${name}<P, Q = Path<P>> = ${chain} unknown;`);
    }
  }
  parts.push('}', '');
  return parts.join('\n');
}

/** What the program's server says at /openapi.json. @param {string} program @returns {Promise<Schema>} */
async function describe(program) {
  const folder = await mkdtemp(join(tmpdir(), 'easeoff-types-'));
  const options = ['--listen', '127.0.0.1:0', '--data', folder, '--web', folder, '--quiet'];
  const server = spawn(resolve(program), ['serve', ...options], { stdio: ['ignore', 'pipe', 'inherit'] });
  const ended = new Promise(done => server.on('exit', done));
  try {
    const address = await new Promise((found, fail) => {
      let text = '';
      server.stdout.on('data', data => {
        text += data;
        const match = /http:\/\/\S+/.exec(text);
        if (match) found(match[0]);
      });
      server.on('error', fail);
      server.on('exit', code => fail(new Error(`${program} serve ended with ${code}`)));
    });
    return await (await fetch(new URL('api/v1/openapi.json', address))).json();
  } finally {
    server.kill('SIGTERM');
    await ended;
    await rm(folder, { recursive: true, force: true });
  }
}

const [program, file] = process.argv.slice(2);
await writeFile(file, declarationOf(await describe(program)));
