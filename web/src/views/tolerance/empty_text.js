// SPDX-License-Identifier: GPL-3.0-or-later
// What stands in the place of the figures of pairs as made while there are none.

/** @param {Api.Design['tolerance']} block what scatters @param {number} asked pairs on their way */
export function emptyText(block, asked) {
  if (asked > 0) return 'The first pairs are on their way.';
  const preset = (block?.preset ?? 'as_stated') !== 'as_stated';
  const chosen = preset || (block?.inputs ?? []).length > 0 || block?.centre_distance;
  if (chosen) return 'Nothing has been drawn yet. How the gears are made stands on the left: draw the pairs.';
  const others =
    'a preset from ISO 1328-1 is enough; inputs of your own stand in the block "tolerance" of the design document.';
  if (block?.single_teeth)
    return (
      'Nothing has been drawn yet. Every pair will have teeth of its own; all else scatters by the tolerance class, ' +
      `as no scatter is chosen: draw the pairs, or choose it on the left: ${others}`
    );
  return `Nothing has been drawn yet. Choose how the gears are made on the left: ${others}`;
}
