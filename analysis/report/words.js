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

export const plural = (count, word) => `${count} ${word}${count === 1 ? '' : 's'}`;

// The readable name of a column with its unit; its own words where the page has none.
export function label(stores, column) {
  if (column === 'beta') return 'exponent β of F(m) ~ m^-β';
  for (const store of stores) if (store.labels.get(column)) return store.labels.get(column);
  const unit = stores.map((store) => store.units.get(column)).find(Boolean);
  return column.replaceAll('_', ' ') + (unit ? ` (${unit})` : '');
}

// A word of a shell's command line.
export const shell = (text) => (/^[\w./:,=+-]+$/.test(text) ? text : `'${String(text).replaceAll("'", "'\\''")}'`);
// The name of a store on a command line; a dash in front would be an option.
export const shellFile = (text) => shell(text.startsWith('-') ? `./${text}` : text);

export function csv(columns, rows) {
  const cell = (value) => {
    const text = value === null || value === undefined ? '' : value instanceof Uint8Array ? '(bytes)' : String(value);
    return /[",\n\r]/.test(text) ? `"${text.replaceAll('"', '""')}"` : text;
  };
  return [columns, ...rows].map((row) => row.map(cell).join(',')).join('\r\n') + '\r\n';
}
