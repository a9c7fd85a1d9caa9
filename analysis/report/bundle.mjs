// node bundle.mjs SOURCE PACKAGES PAGE: puts page.html, page.css, main.js with all that it imports, the WebAssembly of
// sql.js and the licences of the packages into one file. Its content security policy admits this very script and this
// very style sheet, by their hashes, and nothing else: no network, no other script, no eval.
import {createHash} from 'node:crypto';
import {copyFileSync, mkdirSync, readFileSync, readdirSync, writeFileSync} from 'node:fs';
import {createRequire} from 'node:module';
import {dirname, join, resolve} from 'node:path';
import {gzipSync} from 'node:zlib';

const [source, packages, page] = process.argv.slice(2).map((path) => resolve(path));
const modules = join(packages, 'node_modules');
const {build} = createRequire(join(packages, 'fetched'))('esbuild-wasm');

// A package with all that it uses, as its authors publish it for pages: no module, though package.json calls it one.
function published(name) {
  const script = join(packages, `${name}.cjs`);
  copyFileSync(join(modules, name, 'build', `${name}.min.js`), script);
  return script;
}
const vega = published('vega');

async function bundle(file) {
  const result = await build({
    entryPoints: [join(source, file)],
    bundle: true,
    minify: true,
    write: false,
    format: 'iife',
    target: 'es2020',
    charset: 'utf8',
    legalComments: 'none', // all licences stand in the page as a whole
    nodePaths: [modules],
    alias: {vega, 'vega-util': vega, 'vega-lite': published('vega-lite')},
    external: ['fs', 'path', 'crypto'], // of Node; never reached in a browser
    logLevel: 'error',
  });
  return result.outputFiles[0].text.trim();
}

// "NAME VERSION" and the text of the licence of every package; packages with one text share it.
function licences() {
  const texts = new Map();
  for (const name of readdirSync(modules).filter((name) => !name.startsWith('esbuild'))) {
    const folder = join(modules, name);
    const {version, license} = JSON.parse(readFileSync(join(folder, 'package.json'), 'utf8'));
    const file = readdirSync(folder).find((entry) => /^licen[cs]e/i.test(entry));
    const text = file ? readFileSync(join(folder, file), 'utf8').trim() : `Licence: ${license}`;
    texts.set(text, [...(texts.get(text) ?? []), `${name} ${version}`]);
  }
  return [...texts].map(([text, users]) => `${users.join(', ')}\n\n${text}`)
    .concat('SQLite, in sql.js, is in the public domain.').join(`\n\n${'-'.repeat(72)}\n\n`);
}

const hash = (text) => `'sha256-${createHash('sha256').update(text, 'utf8').digest('base64')}'`;
const escape = (text) => text.replace(/&/g, '&amp;').replace(/</g, '&lt;').replace(/>/g, '&gt;');

const script = await bundle('main.js');
const style = await bundle('page.css');
if (/<\/script|<!--/i.test(script)) throw new Error('the script would end its own element');
const wasm = readFileSync(join(modules, 'sql.js/dist/sql-wasm-browser.wasm'));
const parts = {
  policy: `default-src 'none'; script-src ${hash(script)} 'wasm-unsafe-eval'; style-src ${hash(style)}; ` +
    "img-src data: blob:; base-uri 'none'; form-action 'none'",
  style,
  wasm: gzipSync(wasm, {level: 9}).toString('base64'),
  licences: escape(licences()),
  script,
};
const html = readFileSync(join(source, 'page.html'), 'utf8').replace(/\{\{(\w+)\}\}/g, (_, name) => parts[name]);
mkdirSync(dirname(page), {recursive: true});
writeFileSync(page, html);
