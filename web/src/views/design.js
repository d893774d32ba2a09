// SPDX-License-Identifier: GPL-3.0-or-later
// The Design view: parameters left, numbers above, figures right; on a narrow screen one below the other.
import { fill, h } from '../base/dom.js';
import { mainCase } from '../figures/context.js';
import { Headline } from '../headline.js';
import { reportData, reportHead } from '../report.js';
import { Parameters } from './parameters.js';
import { Results } from './results.js';

/** @param {import('../app.js').App} app @returns {import('../app.js').View} */
export function designView(app) {
  const { store, analyst, form } = app;
  const parameters = new Parameters(store, form);
  const headline = new Headline(store);
  const results = new Results();
  const trouble = h('p.trouble', { role: 'alert', hidden: true });
  const top = h('.report');
  const end = h('.report');
  const foot = h('div');
  const element = h(
    '.design-view',
    null,
    top,
    h(
      'aside.form-pane',
      { 'aria-label': 'Parameters' },
      h('.form-scroll', null, parameters.element),
      foot,
      h('.form-foot', null, h('button.primary', { type: 'button', onclick: () => app.go('optimize') }, 'Optimize…')),
    ),
    h('.head-pane', null, headline.element, trouble),
    h('.figure-pane', null, results.element, end),
  );

  const drawResult = () => {
    const { result } = analyst;
    if (!result) return;
    const count = result.load_cases.length;
    const chosen = store.loadCase >= 0 && store.loadCase < count ? store.loadCase : mainCase(result.design);
    const context = { result, references: analyst.references(), loadCase: chosen };
    form.resolved = result.design;
    headline.set(context);
    results.set(context);
  };
  const drawState = () => {
    const stray = form.showFaults(analyst.state === 'refused' ? analyst.faults : []);
    const refused = analyst.state === 'refused';
    trouble.hidden = !refused;
    if (refused) {
      const faulty = store.faults.size + analyst.faults.length;
      trouble.textContent = stray.length
        ? stray.map(({ pointer, detail }) => `${pointer} ${detail}`).join(' ')
        : faulty
          ? `${faulty === 1 ? 'One value is' : `${faulty} values are`} not possible, see the form. The figures show the last design that was.`
          : analyst.message;
    }
    element.classList.toggle('refused', refused);
    element.classList.toggle('preparing', analyst.state === 'preparing');
  };
  const sweep = () => {
    if (store.faults.size || analyst.state === 'refused') return;
    results.speed.set(store.design, store.pin);
    results.torque.set(store.design, store.pin);
  };
  analyst.addEventListener('result', () => {
    drawResult();
    sweep();
  });
  analyst.addEventListener('state', drawState);
  return {
    element,
    show() {
      foot.append(form.help);
      form.refresh();
      drawResult();
      drawState();
    },
    print() {
      const { result } = analyst;
      if (!result) return;
      fill(top, reportHead(store.design.name || 'Gear pair', result));
      fill(end, reportData(app.fields, result));
      results.draw();
    },
  };
}
