// SPDX-License-Identifier: GPL-3.0-or-later
// The dialogs of the first minute, each fetched when it is first asked for.

/** @typedef {import('../app.js').App} App */

/** @param {App} app */
export const openOwnGear = app => app.attempt(async () => (await import('./own_gear.js')).openOwnGear(app));

/** @param {App} app */
export const openExamples = app => app.attempt(async () => (await import('./examples.js')).openExamples(app));

/** @param {App} app */
export const startTour = app => app.attempt(async () => (await import('./tour.js')).startTour(app));
