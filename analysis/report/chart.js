// Charts by Vega-Lite. Their expressions are interpreted, not compiled: the page's policy forbids eval.
import {View, parse} from 'vega';
import {compile} from 'vega-lite';
import {expressionInterpreter} from 'vega-interpreter';
import {commands, download, element, fill} from './elements.js';
import {csv, raisedIn} from './words.js';

// Okabe and Ito's colours, told apart without colour vision; marks and dashes differ, too.
export const COLOURS = ['#0072B2', '#D55E00', '#009E73', '#CC79A7', '#E69F00', '#000000'];
export const SHAPES = ['circle', 'square', 'triangle-up', 'diamond', 'cross', 'triangle-down'];
export const DASHES = [[1, 0], [6, 3], [2, 2], [8, 3, 2, 3], [4, 4], [10, 4]];

const CONFIG = {
  font: 'system-ui, "DejaVu Sans", sans-serif',
  axis: {labelFontSize: 12, titleLimit: 330, titleFontSize: 13, titleFontWeight: 'normal', gridOpacity: 0.5, labelOverlap: true, labelSeparation: 10},
  legend: {labelFontSize: 12, titleFontSize: 13, titleFontWeight: 'normal', titleLimit: 260},
  view: {stroke: '#c8c8c8'},
  range: {category: COLOURS},
};

const views = new Map(); // by figure

// Pixels of a chart with a line of the legend for each name.
export const heightWith = (names) => 340 + (names.length > 1 ? 16 * names.length : 0);

// Draws a figure: the chart, a caption, and what can be taken away. about: {name, description, caption, command, columns,
// rows}; command: one, or one of each store; columns and rows are the numbers that the chart shows.
export async function draw(figure, spec, about) {
  views.get(figure)?.finalize();
  views.delete(figure);
  const chart = element('div', {class: 'chart', role: 'img', 'aria-label': about.description});
  const tools = element('div', {class: 'tools'},
    element('button', {type: 'button', click: async () => download(`${about.name}.svg`, 'image/svg+xml', await views.get(figure).toSVG())}, 'SVG'),
    element('button', {type: 'button', click: () => download(`${about.name}.csv`, 'text/csv', csv(about.columns, about.rows))}, 'CSV'),
    about.command ? commands([about.command].flat()) : null);
  fill(figure, chart, element('figcaption', {}, about.caption), tools);
  const width = Math.max(240, figure.clientWidth);
  const whole = {$schema: 'https://vega.github.io/schema/vega-lite/v6.json', background: 'white', config: {...CONFIG, legend: {...CONFIG.legend, labelLimit: width - 50}},
    width, autosize: {type: 'fit', contains: 'padding'}, ...spec};
  const view = new View(parse(compile(whole).spec, null, {ast: true}),
    {expr: expressionInterpreter, renderer: 'svg', container: chart, hover: true});
  views.set(figure, view);
  await view.runAsync();
  return view.resize().runAsync(); // the first layout changes the ticks, and so the room that their labels need
}

export function nothing(figure, text) {
  views.get(figure)?.finalize();
  views.delete(figure);
  fill(figure, element('p', {class: 'note'}, text));
}

// Ticks of a logarithmic axis: powers of ten; within two decades also their double and fivefold.
function ticks(values) {
  const low = Math.min(...values), high = Math.max(...values), decades = Math.log10(high / low);
  const step = Math.max(1, Math.ceil(decades / 7)), found = [];
  for (let k = Math.floor(Math.log10(low)); k <= Math.log10(high); k += step)
    for (const digit of decades < 2 ? [1, 2, 5] : [1]) found.push(Number(`${digit}e${k}`));
  return found.filter((tick) => tick >= low && tick <= high);
}

// 2.5×10³³ for 2.5e+33.
const SHORT = "format(datum.value, '.4~g')";
export const NUMBER = `!isNumber(datum.value) ? datum.value : !test(/e/, ${SHORT}) ? ${SHORT} : replace(replace(${SHORT}, /e.*/, '×10'), /^1×/, '') + ${raisedIn(`toNumber(replace(${SHORT}, /.*e/, ''))`)}`;
const POWER = `'10' + ${raisedIn('round(log(datum.value) / LN10)')}`;

// The ticks of a logarithmic axis, named by powers of ten or, within two decades, by numbers: never both.
export function logAxis(values) {
  const positive = values.filter((value) => value > 0);
  return {values: ticks(positive), labelExpr: Math.max(...positive) / Math.min(...positive) < 100 ? NUMBER : POWER};
}

// A title in lines that fit into a figure.
export function wrapped(title, figure) {
  const most = Math.max(20, (figure.clientWidth - 60) / 7); // letters
  return title.split(' ').reduce((lines, word) => {
    const last = lines[lines.length - 1];
    return last.length + word.length < most ? [...lines.slice(0, -1), `${last} ${word}`.trim()] : [...lines, word];
  }, ['']);
}

// Pixels between a frame and the first and the last mark, which it would cut.
export const ROOM = {nice: false, padding: 14};

// A scale of positive numbers that span a factor of 20 is logarithmic, if their median is nearer to the middle of such a scale.
export function scale(values) {
  const numbers = values.filter((value) => typeof value === 'number').sort((a, b) => a - b);
  const low = numbers[0], high = numbers[numbers.length - 1], median = numbers[Math.floor(numbers.length / 2)];
  const even = Math.abs((median - low) / (high - low) - 0.5), byFactors = Math.abs(Math.log(median / low) / Math.log(high / low) - 0.5);
  return low > 0 && high / low >= 20 && even >= byFactors ? {type: 'log', ...ROOM} : {zero: false, ...ROOM};
}
