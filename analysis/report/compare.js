// Two stores and more: the points that they have in common, side by side.
import {body, command, element, fill, table} from './elements.js';
import {cells, doubtSentence} from './plane.js';
import {inputsOf} from './spectrum.js';
import * as questions from './questions.js';
import {isNamed, state} from './state.js';
import {ask, has, matchesOf} from './stores.js';
import {label, marked, number, onlyOf, operandOf, withError, withInterval} from './words.js';

const SHOWN = 500;

// The differences that clast computed, by the points of both stores.
function differencesOf(first, other) {
  if (!has(other, 'difference') || first.whole) return new Map();
  return new Map(ask(other, questions.differences, {quantity: state.quantity}).map((row) =>
    [`${row.first_point} ${row.point_id}`, `${withError(row.difference, row.hw95)}${row.pairs ? `, ${row.pairs} pairs` : ''}`]));
}

export function showCompare() {
  const section = document.getElementById('compare');
  section.hidden = state.stores.length < 2;
  if (section.hidden) return;
  const [first, ...others] = state.stores;
  const differences = others.map((other) => differencesOf(first, other));
  const known = others.map((other) => new Map(cells(other, state.quantity).flatMap((cell) => matchesOf(other, cell).map((place) => [place, cell]))));
  const partner = (cell, i) => matchesOf(first, cell).map((place) => known[i].get(place)).find(Boolean);
  const rows = cells(first, state.quantity).map((cell) => [cell, ...others.map((_, i) => partner(cell, i))]).filter((row) => row.slice(1).some(Boolean));
  const named = state.stores.some(isNamed);
  const inputs = (row) => [...new Set(row.flatMap((cell, i) => (!cell ? [] : named ? [inputsOf(state.stores[i], cell, isNamed(state.stores[i]) ? undefined : state.stores[i].axes)]
    : state.stores[i].axes.map((axis) => inputsOf(state.stores[i], cell, [axis])))))].filter(Boolean).join(named ? '; ' : ', ') || 'the only point';
  const shown = (cell) => (cell ? `${marked(withInterval(cell), cell.doubt, cell.n)}, n=${cell.n ?? 0}` : '-');
  const {campaign, ...rest} = first.facts, chosen = {facts: first.name === first.facts.file ? first.facts : rest}; // STORE:CAMPAIGN names its own
  const both = (a, b) => (a.doubt || b?.doubt ? {withheld: 0} : null);
  const less = (a, b, i) => marked(plainly(a, b, i), both(a, b));
  const plainly = (a, b, i) => differences[i].get(`${a.point_id} ${b?.point_id}`) ?? (b && a.mean !== null && b.mean !== null ? number(b.mean - a.mean, 3) : '-');
  const title = label(state.stores, state.quantity);
  // Inputs that no store varies; of a dropped store the page does not know them.
  const apart = others.map((other) => (first.whole || other.whole ? `${first.name} and ${other.name} may also differ in inputs that they do not vary: the command below tells them.`
    : other.facts.apart ? `${first.name} and ${other.name} ${rows.length ? 'also ' : ''}differ in ${other.facts.apart}.` : ''));
  const none = others.filter((other) => other.facts.no_pair).map((other) => ` ${other.name}: ${other.facts.no_pair}.`);
  fill(body('compare'),
    ...apart.filter(Boolean).map((text) => element('p', {}, text)),
    rows.length ? table(`${title} of ${!named || rows.every((row) => inputs(row) === inputs([row[0]])) ? 'the common points' : others.length > 1 ? 'the named points' : 'two points'}; ± is the 95 % interval over seeds`,
      ['inputs', first.name, ...others.flatMap((other) => [other.name, `${other.name} minus ${first.name}`])],
      rows.slice(0, SHOWN).map(([cell, ...rest]) => [inputs([cell, ...rest]), shown(cell), ...rest.flatMap((other, i) => [shown(other), less(cell, other, i)])]))
      : element('p', {}, `These stores have no point in common${state.stores.some((one) => one.whole) ? ' by what both vary' : ''}.${none.join('')}`),
    element('p', {}, doubtSentence(state.stores.map((one, i) => [one, [...new Set(rows.map((row) => row[i]).filter(Boolean))]]))),
    rows.length ? element('p', {}, 'Where at least half of the runs have one seed on both sides, the difference is of these pairs. The same from a shell:') : null,
    ...(state.quantity === 'beta' ? [] : others.filter((other) => !other.facts.no_pair).map((other) => element('p', {}, command(`clast compare ${operandOf(first)} ${operandOf(other)}${onlyOf(chosen)} --quantity ${state.quantity}`)))));
}
