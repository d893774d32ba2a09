// SPDX-License-Identifier: GPL-3.0-or-later
// What the name of a rig file says about the run.

/** "mod_828Nm_2000rpm.csv", "u-828-2000.tdms"; "" where it says nothing. @param {string} name */
export function guess(name) {
  const words = name.toLowerCase();
  /** @param {RegExp} pattern */
  const number = pattern => pattern.exec(words)?.[1]?.replace(',', '.') ?? '';
  const bare = [...words.replace(/\.[a-z]\w*(\.gz)?$/, '').matchAll(/(?<![a-z0-9.])\d+(?:\.\d+)?(?![a-z0-9.])/g)].map(
    match => match[0],
  );
  return {
    label: /unmod|without|ohne|(^|[^a-z])u[^a-z]/.test(words)
      ? 'unmodified'
      : /mod|mit|(^|[^a-z])m[^a-z]/.test(words)
        ? 'modified'
        : '',
    torque: number(/(\d+(?:[.,]\d+)?)[ _-]?n[ _-]?m(?![a-z])/) || (bare.length >= 2 ? bare[bare.length - 2] : ''),
    speed: number(/(\d+(?:[.,]\d+)?)[ _-]?(?:rpm|min)/) || (bare.length >= 2 ? bare[bare.length - 1] : ''),
  };
}
