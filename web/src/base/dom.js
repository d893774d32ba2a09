// SPDX-License-Identifier: GPL-3.0-or-later
// Elements without markup strings: h('button.quiet', { onclick }, 'Text').

/** @typedef {Node | string | number | null | undefined | false | readonly any[]} Child */

/** @param {Element} element @param {Record<string, any>} attributes */
function assign(element, attributes) {
  for (const [name, value] of Object.entries(attributes)) {
    if (value === null || value === undefined || value === false) continue;
    if (name.startsWith('on')) element.addEventListener(name.slice(2), value);
    else if (name === 'css') {
      for (const [property, text] of Object.entries(value))
        /** @type {HTMLElement} */ (element).style.setProperty(property, String(text));
    } else if (
      name === 'value' ||
      name === 'checked' ||
      name === 'disabled' ||
      name === 'selected' ||
      name === 'hidden' ||
      name === 'open'
    )
      /** @type {any} */ (element)[name] = value;
    else element.setAttribute(name, value === true ? '' : String(value));
  }
}

/** @param {Element} element @param {readonly Child[]} children */
function append(element, children) {
  for (const child of children) {
    if (child === null || child === undefined || child === false) continue;
    if (Array.isArray(child)) append(element, child);
    else element.append(child instanceof Node ? child : String(child));
  }
}

/**
 * The element type that "tag.class" makes.
 * @template {string} T
 * @typedef {T extends keyof HTMLElementTagNameMap ? HTMLElementTagNameMap[T]
 *   : T extends `${infer Tag}.${string}`
 *   ? (Tag extends keyof HTMLElementTagNameMap ? HTMLElementTagNameMap[Tag] : HTMLElement) : HTMLElement} ElementOf
 */

/**
 * @template {string} T
 * @param {T} name
 * @param {Record<string, any> | null} [attributes]
 * @param {...Child} children
 * @returns {ElementOf<T>}
 */
export function h(name, attributes, ...children) {
  const [tag, ...classes] = name.split('.');
  const element = document.createElement(tag || 'div');
  if (classes.length) element.className = classes.join(' ');
  if (attributes) assign(element, attributes);
  append(element, children);
  return /** @type {any} */ (element);
}

/** @param {Element} element @param {...Child} children */
export function fill(element, ...children) {
  element.replaceChildren();
  append(element, children);
}

let count = 0;
/** A new id for labels and descriptions. @param {string} [stem] */
export function newId(stem = 'e') {
  count += 1;
  return `${stem}-${count}`;
}

/** Offers bytes as a download. @param {string} name @param {Blob} blob */
export function download(name, blob) {
  const address = URL.createObjectURL(blob);
  const link = h('a', { href: address, download: name });
  link.click();
  setTimeout(() => URL.revokeObjectURL(address), 10000);
}

/** A name that any file system takes. @param {string} text */
export function fileName(text) {
  return (
    text
      .toLowerCase()
      .replace(/[^a-z0-9]+/g, '-')
      .replace(/^-|-$/g, '') || 'design'
  );
}

/** @param {string} text */
export async function copyText(text) {
  try {
    await navigator.clipboard.writeText(text);
  } catch {
    const area = h('textarea', { value: text, 'aria-hidden': 'true', class: 'away' });
    document.body.append(area);
    area.select();
    document.execCommand('copy');
    area.remove();
  }
}

/**
 * Draws, but later while something of the place is held down: a click is lost on a button that is replaced under it.
 * @param {HTMLElement} place @param {() => void} draw
 */
export function unlessHeld(place, draw) {
  let [held, late] = [false, false];
  const release = () =>
    setTimeout(() => {
      held = false; // the click has been told
      if (late) draw();
      late = false;
    });
  place.addEventListener('pointerdown', () => {
    held = true;
    for (const end of ['pointerup', 'pointercancel']) window.addEventListener(end, release, { once: true });
  });
  return () => {
    if (held) late = true;
    else draw();
  };
}
