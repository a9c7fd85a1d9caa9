// How much the seed matters: histogram and quantiles of the quantity over the runs of the chosen points.
import {body, fill, table} from './elements.js';
import {COLOURS, draw, nothing} from './chart.js';
import * as questions from './questions.js';
import {nameOf} from './spectrum.js';
import {chosenPoints, state, store} from './state.js';
import {summary} from './statistics.js';
import {ask} from './stores.js';
import {label, number, plural, shellFile, withError} from './words.js';

function valuesOf(from, point, quantity) {
  const rows = ask(from, questions.values(quantity), {point: point.point_id});
  const version = rows[rows.length - 1]?.results_version;
  return rows.filter((row) => row.results_version === version && typeof row.value === 'number').map((row) => row.value);
}

// Of one step for all samples: Freedman and Diaconis' (2 quartile ranges over the cube root of n), 5 to 60 bins.
function stepOf(values) {
  const {n, least, largest, quarter, threeQuarters} = summary(values);
  const step = (2 * (threeQuarters - quarter)) / Math.cbrt(n) || (largest - least) / 10;
  const wanted = Math.min(Math.max(step, (largest - least) / 60), (largest - least) / 5) || 1;
  const power = 10 ** Math.floor(Math.log10(wanted));
  return power * [1, 2, 5, 10].reduce((best, factor) => (Math.abs(factor * power - wanted) < Math.abs(best * power - wanted) ? factor : best), 1);
}

export async function showSeeds() {
  const figure = document.querySelector('#seeds figure'), below = body('seeds'), quantity = state.quantity, from = store();
  fill(below);
  if (!from.runColumns.has(quantity))
    return nothing(figure, quantity === 'beta' ? 'An exponent belongs to all runs of a point together: choose another quantity.' : 'Single runs of this quantity are not on this page (see "left out here").');
  const samples = chosenPoints().map((point) => ({point, name: nameOf(from, point), values: valuesOf(from, point, quantity)})).filter((sample) => sample.values.length);
  if (samples.length === 0) return nothing(figure, 'No run of the chosen points is on this page.');
  const apart = samples.length <= COLOURS.length;
  const rows = samples.flatMap((sample) => sample.values.map((value) => ({name: apart ? sample.name : 'all chosen points', value})));
  const all = rows.map((row) => row.value), title = label(state.stores, quantity);
  const names = [...new Set(rows.map((row) => row.name))];
  const x = {field: 'value', type: 'quantitative', bin: {step: stepOf(all)}, title, scale: {zero: false}};
  const means = apart ? samples.map((sample) => ({name: sample.name, ...summary(sample.values)})) : [{name: names[0], ...summary(all)}];
  const colour = {field: 'name', type: 'nominal', scale: {domain: names, range: COLOURS}, legend: names.length > 1 ? {orient: 'bottom', direction: 'vertical', title: null} : null};
  await draw(figure, {data: {values: rows}, height: 340, layer: [
    {mark: {type: 'bar', opacity: names.length > 1 ? 0.55 : 0.8, stroke: 'white'}, encoding: {x, y: {aggregate: 'count', stack: null, title: 'runs'}, color: colour}},
    {data: {values: means}, mark: {type: 'rule', strokeWidth: 3}, encoding: {x: {field: 'mean', type: 'quantitative'}, color: colour}},
  ]}, {
    name: 'seeds', description: `Histogram of ${title} over ${plural(all.length, 'run')}`,
    caption: `${title} of ${plural(all.length, 'run')}${apart ? '' : `, ${samples.length} points together`}. Line: mean.`,
    command: `clast query ${shellFile(from.name)} "${questions.valuesForShell(quantity, samples.map((sample) => sample.point.point_id))}" --csv`,
    columns: ['point', quantity], rows: rows.map((row) => [row.name, row.value]),
  });
  fill(below, table(`${title}: mean with its 95 % interval over seeds, and quantiles of the runs`,
    ['', ...means.map((row) => row.name)],
    [['mean', (row) => withError(row.mean, row.hw95)], ['standard deviation', (row) => number(row.sd)], ['least', (row) => number(row.least)],
      ['quarter', (row) => number(row.quarter)], ['median', (row) => number(row.median)], ['three quarters', (row) => number(row.threeQuarters)],
      ['largest', (row) => number(row.largest)], ['runs here', (row) => row.n]].map(([word, value]) => [word, ...means.map(value)])));
}
