// Two stores and more: the points that they have in common, side by side.
import {body, command, element, fill, table} from './elements.js';
import {cells} from './plane.js';
import {inputsOf} from './spectrum.js';
import {state} from './state.js';
import {label, number, shellFile, withError} from './words.js';

const SHOWN = 500;

const keyOf = (from, point) => JSON.stringify(from.axes.map((axis) => [axis.column_name, point[axis.column_name]]).sort());

export function showCompare() {
  const section = document.getElementById('compare');
  section.hidden = state.stores.length < 2;
  if (section.hidden) return;
  const [first, ...others] = state.stores;
  const known = others.map((other) => new Map(cells(other, state.quantity).map((cell) => [keyOf(other, cell), cell])));
  const rows = cells(first, state.quantity).map((cell) => [cell, ...known.map((map) => map.get(keyOf(first, cell)))]).filter((row) => row.slice(1).some(Boolean));
  const shown = (cell) => (cell ? `${withError(cell.mean, cell.hw95)}, n=${cell.n ?? 0}` : '-');
  const less = (a, b) => (a && b && a.mean !== null && b.mean !== null ? number(b.mean - a.mean, 3) : '-');
  const title = label(state.stores, state.quantity);
  fill(body('compare'),
    rows.length ? table(`${title} of the points with the same varied inputs; ± is the 95 % interval over seeds`,
      ['inputs', first.name, ...others.flatMap((other) => [other.name, 'difference'])],
      rows.slice(0, SHOWN).map(([cell, ...rest]) => [inputsOf(first, cell) || 'the only point', shown(cell), ...rest.flatMap((other) => [shown(other), less(cell, other)])]))
      : element('p', {}, 'These stores have no point in common: their varied inputs differ.'),
    element('p', {}, 'Where both stores have the same seeds, the difference is known better than each mean. This command pairs the seeds and gives its interval: '),
    ...(state.quantity === 'beta' ? [] : others.map((other) => element('p', {}, command(`clast compare ${shellFile(first.name)} ${shellFile(other.name)} --quantity ${state.quantity}`)))));
}
