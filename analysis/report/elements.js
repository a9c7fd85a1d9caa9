// HTML elements. Text of a store is only ever given to textContent and to attributes: it is never read as HTML.

export function element(tag, attributes = {}, ...children) {
  const made = document.createElement(tag);
  for (const [key, value] of Object.entries(attributes)) {
    if (typeof value === 'function') made.addEventListener(key, value);
    else if (value === true) made.setAttribute(key, '');
    else if (value !== false && value !== null && value !== undefined) made.setAttribute(key, value);
  }
  made.append(...children.filter((child) => child !== null && child !== undefined));
  return made;
}

export const fill = (parent, ...children) => parent.replaceChildren(...children.filter((child) => child));
export const body = (id) => document.querySelector(`#${id} .body`);

// A table with a caption. cells: text, numbers or elements. sort: called with the index of a column.
export function table(caption, headings, rows, sort) {
  const head = headings.map((heading, i) => element('th', {scope: 'col'},
    sort ? element('button', {type: 'button', click: () => sort(i)}, heading) : heading));
  const lines = rows.map((row) => element('tr', {}, ...row.map((cell, i) =>
    element('td', {'data-heading': headings[i], class: typeof cell === 'number' || /^-?[\d.]+(e-?\d+|×10[⁻⁰¹²³⁴⁵⁶⁷⁸⁹]+)?( ± .*| \(.*\))?( !)?$/.test(cell) ? 'number' : null},
      cell instanceof Node ? cell : String(cell ?? '-')))));
  return element('div', {class: 'scroll', tabindex: 0, role: 'region', 'aria-label': caption},
    element('table', {}, element('caption', {}, caption), element('thead', {}, element('tr', {}, ...head)),
      element('tbody', {}, ...lines)));
}

export function list(pairs) {
  return element('dl', {}, ...pairs.flatMap(([term, text]) => [element('dt', {}, term), element('dd', {}, text)]));
}

export function select(name, title, options, value, change) {
  const made = element('select', {name, change: () => change(made.value)},
    ...options.map(([key, text]) => element('option', {value: key, selected: key === value}, text)));
  return element('label', {}, title, made);
}

export function download(name, type, text) {
  const address = URL.createObjectURL(new Blob([text], {type}));
  element('a', {href: address, download: name}).click();
  setTimeout(() => URL.revokeObjectURL(address), 10000);
}

// The command that gives the same from a shell, and a button that copies it.
export function command(text) {
  const code = element('code', {}, text);
  const button = element('button', {type: 'button', click: async () => {
    try {
      await navigator.clipboard.writeText(text);
      button.textContent = 'Copied';
    } catch {
      getSelection().selectAllChildren(code); // a browser that refuses: the text is marked, Ctrl-C copies it
    }
  }}, 'Copy');
  return element('span', {}, code, ' ', button);
}

// Of several stores each has its own line.
export const commands = (texts) => (texts.length === 1 ? command(texts[0])
  : element('div', {class: 'commands'}, 'One command of each store:', ...texts.map(command)));
