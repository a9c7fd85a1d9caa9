// How much the seed matters: histogram and quantiles of the quantity over the runs of the chosen points.
import {body, fill, table} from './elements.js';
import {COLOURS, DASHES, draw, heightWith, nothing} from './chart.js';
import {cells, doubtSentence, modesText} from './plane.js';
import * as questions from './questions.js';
import {commandsOf, nameOf} from './spectrum.js';
import {chosenPoints, drawnPoints, state, store} from './state.js';
import {quantileInterval, summary} from './statistics.js';
import {ask, has} from './stores.js';
import {between, label, marked, number, plural, rangeOf, withInterval} from './words.js';

function valuesOf(from, point, quantity) {
  const rows = ask(from, questions.values(quantity), {point: point.point_id});
  const version = rows[rows.length - 1]?.results_version;
  return rows.filter((row) => row.results_version === version && typeof row.value === 'number').map((row) => row.value);
}

// Bins of one width for all samples, 1, 2 or 5 times a power of ten: at most Freedman and Diaconis' width (two quartile
// ranges over the cube root of n, of the smallest sample), 8 to 80 bins.
function stepOf(samples) {
  const all = summary(samples.flatMap((sample) => sample.values)), range = all.largest - all.least;
  const widths = samples.map(({values}) => summary(values)).map((of) => (2 * (of.threeQuarters - of.quarter)) / Math.cbrt(of.n)).filter((width) => width > 0);
  const wanted = Math.min(Math.max(Math.min(range / 8, ...widths), range / 80), range / 8) || Math.abs(all.largest) / 10 || 1; // equal values
  const power = 10 ** Math.floor(Math.log10(wanted) + 1e-9);
  return power * [5, 2, 1].find((factor) => factor * power <= wanted * (1 + 1e-9));
}

// Runs in each bin from the first to the last that a sample has, and empty ones at both ends.
function histogram({name, values}, step) {
  const bins = values.map((value) => Math.floor(value / step + 1e-9)), counts = new Map();
  for (const bin of bins) counts.set(bin, (counts.get(bin) ?? 0) + 1);
  const low = Math.min(...bins), high = Math.max(...bins);
  return Array.from({length: high - low + 3}, (_, i) => low - 1 + i).map((bin) => ({name, low: bin * step, high: (bin + 1) * step, runs: counts.get(bin) ?? 0}));
}

export async function showSeeds() {
  const figure = document.querySelector('#seeds figure'), below = body('seeds'), quantity = state.quantity, from = store();
  fill(below);
  if (!from.runColumns.has(quantity))
    return nothing(figure, quantity === 'beta' ? 'An exponent belongs to all runs of a point together: choose another quantity.' : 'Single runs of this quantity are not on this page (see "left out here").');
  const samples = drawnPoints().drawn.filter((sample) => sample.from.runColumns.has(quantity))
    .map((sample) => ({...sample, name: nameOf(sample.from, sample.point), values: valuesOf(sample.from, sample.point, quantity)})).filter((sample) => sample.values.length);
  if (samples.length === 0) {
    const kept = chosenPoints().some((point) => ask(from, questions.values('run_id'), {point: point.point_id}).length);
    return nothing(figure, kept ? `No run of the chosen points has a value of this quantity.${doubtSentence([[from, cells(from, quantity).filter((cell) => state.chosen.has(cell.point_id))]])}`
      : 'No run of the chosen points is on this page.');
  }
  const apart = samples.length <= COLOURS.length;
  const drawn = apart ? samples : [{name: 'all chosen points', values: samples.flatMap((sample) => sample.values)}];
  const all = drawn.flatMap((sample) => sample.values), title = label(state.stores, quantity), step = stepOf(drawn);
  const names = drawn.map((sample) => sample.name);
  const range = Math.max(...all) - Math.min(...all) || 1; // neighbouring ticks have different numbers
  const digits = Math.max(3, Math.ceil(Math.log10(Math.max(...all.map(Math.abs), range) / range)) + 2);
  const x = {field: 'low', type: 'quantitative', title, scale: {zero: false, nice: false}, axis: {tickCount: 6, labelOverlap: true, format: `.${digits}~g`}};
  const y = {field: 'runs', type: 'quantitative', title: 'runs', axis: {tickMinStep: 1, format: 'd'}};
  const cellsOf = new Map([...new Set(samples.map((sample) => sample.from))].map((one) => [one, new Map(cells(one, quantity).map((cell) => [cell.point_id, cell]))]));
  const whole = (sample) => cellsOf.get(sample.from).get(sample.point.point_id);
  const doubts = doubtSentence(samples.map((sample) => [sample.from, [whole(sample)]]));
  const means = drawn.map((sample) => ({name: sample.name, ...summary(sample.values, rangeOf(state.stores, quantity)), all: apart ? whole(sample) : null}));
  const colour = {field: 'name', type: 'nominal', scale: {domain: names, range: COLOURS}, legend: names.length > 1 ? {orient: 'bottom', direction: 'vertical', title: null} : null};
  const dash = {field: 'name', type: 'nominal', scale: {domain: names, range: DASHES}, legend: colour.legend};
  const shape = names.length > 1
    ? {mark: {type: 'line', interpolate: 'step-after', strokeWidth: 2}, encoding: {x, y, color: colour, strokeDash: dash}}
    : {mark: {type: 'bar', stroke: 'white'}, encoding: {x: {...x, bin: 'binned'}, x2: {field: 'high'}, y, color: colour}};
  await draw(figure, {data: {values: drawn.flatMap((sample) => histogram(sample, step))}, height: heightWith(names), layer: [shape,
    {data: {values: means}, mark: {type: 'rule', strokeWidth: 1.5, strokeDash: [5, 3]}, encoding: {x: {field: 'mean', type: 'quantitative'}, color: names.length > 1 ? colour : {value: 'black'}}},
  ]}, {
    name: 'seeds', description: `Histogram of ${title} over ${plural(all.length, 'run')}`,
    caption: `${title} of ${plural(all.length, 'run')}${apart ? '' : `, ${samples.length} points together`}. Dashed lines: means.${doubts}`,
    command: commandsOf(samples, ['clast scatter', `${apart ? '' : ' --by ""'} --quantity ${quantity}`, 'seeds']),
    columns: ['point', quantity], rows: samples.flatMap((sample) => sample.values.map((value) => [sample.name, value])),
  });
  const mean = (row) => (row.all ? `${marked(withInterval(row.all), row.all.doubt, row.all.n)}, n=${row.all.n}` : withInterval(row));
  const known = apart ? samples.map((sample) => new Map((has(sample.from, 'quantile') ? ask(sample.from, questions.quantiles, {quantity, point: sample.point.point_id}) : []).map((row) => [row.share, row]))) : [];
  const quantileOf = (share, key) => (row, i) => {
    const all = known[i]?.get(share);
    if (all) return between(all.value, all.low, all.high);
    const {from: own, point, values} = drawn[i]; // an interval is of all runs of a point
    const {low, high} = apart && valuesOf(own, point, 'run_id').length === point.n ? quantileInterval(Float64Array.from(values).sort(), share) : {low: null, high: null};
    return between(row[key], low, high);
  };
  const lines = [['mean', mean], ['median', quantileOf(0.5, 'median')], ['lower quartile', quantileOf(0.25, 'quarter')], ['upper quartile', quantileOf(0.75, 'threeQuarters')],
    ['standard deviation of the runs here', (row) => number(row.sd)], ['smallest here', (row) => number(row.least)], ['largest here', (row) => number(row.largest)], ['runs here', (row) => row.n]];
  if (means.some((row) => row.all?.modes)) lines.splice(1, 0, ['modes', (row) => (row.all ? modesText(row.all) : '-')]);
  fill(below, table(`${title}: mean and quantiles with their 95 % intervals over seeds, as far as the runs tell them`,
    ['', ...names], lines.map(([word, value]) => [word, ...means.map(value)])));
}
