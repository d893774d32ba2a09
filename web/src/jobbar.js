// SPDX-License-Identifier: GPL-3.0-or-later
// The bar below every view: the search that runs, how far it is, how long it still takes.
import { connection, post } from './base/api.js';
import { fill, h, unlessHeld } from './base/dom.js';
import { choiceText, duration, sig } from './base/format.js';
import { ACTIVE } from './base/jobs.js';

/** @param {Api.Job} job */
export function progressText(job) {
  const { progress, state, stopping } = job;
  if (stopping) return 'stopping';
  if (state === 'queued') return 'waiting';
  if (state === 'preparing') return 'preparing the teeth';
  if (state !== 'running') return state;
  const generations = job.design?.optimization?.generations;
  const parts = [
    typeof progress?.generation === 'number'
      ? `gen ${progress.generation + 1}${generations ? `/${generations}` : ''}`
      : progress?.what,
  ];
  if (typeof progress?.pfc_percent === 'number') parts.push(`PFC ${Math.round(progress.pfc_percent)} %`);
  return parts.filter(Boolean).join('  ');
}

/**
 * A bar; unknown progress is told as such.
 * @param {{ id?: number, name: string, state?: string, progress?: { fraction: number | null } }} job
 */
export function progressBar(job) {
  const fraction = job.state === 'done' ? 1 : (job.progress?.fraction ?? 0);
  const bar = h(
    'span.progress',
    {
      role: 'progressbar',
      'aria-label': `Progress of ${job.name || `job ${job.id}`}`,
      'aria-valuemin': 0,
      'aria-valuemax': 100,
      'aria-valuenow': Math.round(100 * fraction),
    },
    h('span'),
  );
  /** @type {HTMLElement} */ (bar.firstElementChild).style.width = `${100 * fraction}%`;
  return bar;
}

/** @param {Api.Job} job */
function leftText(job) {
  if (connection.away) return 'no connection';
  const left = job.progress?.seconds_left;
  return typeof left === 'number' ? `${duration(left)} left` : '';
}

export class JobBar {
  /** @param {import('./app.js').App} app */
  constructor(app) {
    this.app = app;
    this.element = h('footer.job-bar', { 'aria-label': 'Jobs' });
    const draw = unlessHeld(this.element, () => this.#draw());
    app.jobs.addEventListener('change', draw);
    connection.addEventListener('change', draw);
    draw();
  }

  #draw() {
    const searches = this.app.jobs.searches();
    const active = searches.filter(job => ACTIVE.includes(job.state));
    const job = active.find(each => each.state === 'running') ?? active[active.length - 1];
    if (!job) {
      const last = searches.find(each => each.state === 'done');
      fill(
        this.element,
        h('span.job-name', null, 'No search runs.'),
        last
          ? h(
              'button.link',
              { type: 'button', onclick: () => this.app.go('optimize', { job: String(last.id) }) },
              `last: ${last.name || 'unnamed'}, J ${sig(last.best?.J, 3)}`,
            )
          : null,
      );
      return;
    }
    const more = active.length - 1;
    fill(
      this.element,
      h(
        'button.link.job-name',
        { type: 'button', onclick: () => this.app.go('optimize', { job: String(job.id) }) },
        job.name || `job ${job.id}`,
      ),
      h('span.algorithm', null, choiceText(job.algorithm ?? '')),
      h('span', null, progressText(job)),
      h('span', null, job.best ? `best J ${sig(job.best.J, 3)}` : ''),
      progressBar(job),
      h('span.left', null, leftText(job)),
      h(
        'button.small',
        {
          type: 'button',
          disabled: Boolean(job.stopping) || connection.away,
          onclick: () =>
            post(`jobs/${job.id}/cancel`, {})
              .then(answer => this.app.jobs.put(answer))
              .catch(() => this.app.jobs.reload()),
        },
        'stop',
      ),
      more > 0 ? h('button.link', { type: 'button', onclick: () => this.app.go('optimize') }, `+${more} more`) : null,
    );
  }
}
