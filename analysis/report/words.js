// Numbers, names and shell words for people.

export function number(value, digits = 4) {
  if (value === null || value === undefined || Number.isNaN(value)) return '-';
  if (typeof value !== 'number') return String(value);
  if (Number.isInteger(value) && Math.abs(value) < 1e15) return String(value);
  const size = Math.abs(value);
  if (size >= 1e5 || size < 1e-3) return value.toExponential(digits - 1).replace(/\.?0+e/, 'e').replace('e+', 'e');
  return String(Number(value.toPrecision(digits)));
}

export const withError = (mean, half) =>
  half === null || half === undefined ? `${number(mean)}` : `${number(mean)} ± ${number(half, 2)}`;

// A mean with its interval; of equal shares, what they bound.
export function withInterval({mean, hw95, low95, high95, weak}) {
  if (hw95 === null && typeof low95 === 'number') return `${number(mean)} (all equal: ${number(low95, 3)} to ${number(high95, 3)})`;
  return withError(mean, hw95) + (weak ? ' (weak)' : '');
}

// A number that rests on runs in doubt has a "!"; where the values of some are withheld, also the number of the others.
export const marked = (text, doubt, n) => (!doubt || text === '-' ? text : `${text}${doubt.withheld ? ` (${n - doubt.withheld})` : ''} !`);

export const plural = (count, word) => `${count} ${word}${count === 1 ? '' : 's'}`;

// The first store that names a column decides its name and its unit: inputs are shown in the unit that the campaign
// gives them in, and one of it is `factor` in SI.
const named = (stores, column) => stores.map((store) => store.labels.get(column)).find(Boolean);

// A result between 0 and 1.
export const isShare = (stores, column) => Boolean(named(stores, column)?.share);

// The column in SI by its own words.
export function plain(stores, column) {
  const unit = stores.map((store) => store.units.get(column)).find(Boolean);
  return column.replaceAll('_', ' ') + (unit ? ` (${unit})` : '');
}

export function label(stores, column) {
  if (column === 'beta') return 'exponent β of F(m) ~ m^-β';
  const entry = named(stores, column);
  return entry ? entry.label + (entry.unit ? ` (${entry.unit})` : '') : plain(stores, column);
}

// That unit behind a number.
export function unitOf(stores, column) {
  const unit = named(stores, column)?.unit;
  return unit ? ` ${unit}` : '';
}

// A value of the store in the unit of label().
export const inUnit = (stores, column, value) => (typeof value === 'number' ? value / (named(stores, column)?.factor ?? 1) : value);

// A word of a shell's command line.
export const shell = (text) => (/^[\w./:,=+-]+$/.test(text) ? text : `'${String(text).replaceAll("'", "'\\''")}'`);
// The name of a store on a command line; a dash in front would be an option.
export const shellFile = (text) => shell(text.startsWith('-') ? `./${text}` : text);

// A text that a spreadsheet would run as a formula gets an apostrophe, as in the tables of clast.
export function csv(columns, rows) {
  const cell = (value) => {
    const bare = value === null || value === undefined ? '' : value instanceof Uint8Array ? '(bytes)' : String(value);
    const text = typeof value === 'string' && /^\s*[=+\-@]/.test(value) && Number.isNaN(Number(value)) ? `'${bare}` : bare;
    return /[",\n\r]/.test(text) ? `"${text.replaceAll('"', '""')}"` : text;
  };
  return [columns, ...rows].map((row) => row.map(cell).join(',')).join('\r\n') + '\r\n';
}
