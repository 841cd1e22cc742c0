// SPDX-License-Identifier: Apache-2.0
// Builds bundle/index.html: one file with its script and style in it, that loads nothing. The same
// sources give the same bytes.
import {createHash} from 'node:crypto';
import {existsSync, readFileSync, readdirSync} from 'node:fs';
import {join} from 'node:path';
import {defineConfig, type Plugin} from 'vite';

const hashOf = (text: string) => `'sha256-${createHash('sha256').update(text).digest('base64')}'`;

/// Puts the script and the style into the page, and names both by their hashes in its policy: a
/// script that somebody else brings in does not run.
function oneFile(): Plugin {
  return {
    name: 'one-file',
    enforce: 'post',
    generateBundle(_, bundle) {
      const page = bundle['index.html'];
      if (page?.type !== 'asset') throw new Error('there is no index.html');
      let html = String(page.source);
      const hashes = {script: '', style: ''};
      for (const [name, file] of Object.entries(bundle)) {
        if (file.type === 'chunk') {
          const code = file.code.trim().replaceAll('</script', '<\\/script');
          hashes.script = hashOf(code);
          html = html.replace(/<script type="module"[^>]*><\/script>/, '');
          html = html.replace('</body>', () => `<script type="module">${code}</script>\n</body>`);
        } else if (name.endsWith('.css')) {
          const style = String(file.source).trim();
          hashes.style = hashOf(style);
          html = html.replace(/<link rel="stylesheet"[^>]*>/, () => `<style>${style}</style>`);
        } else {
          continue;
        }
        delete bundle[name];
      }
      page.source = html.replace('SCRIPT_HASH', hashes.script).replace('STYLE_HASH', hashes.style);
    },
  };
}

/// Writes licences.txt: of each package whose code is in the page, its licence as it came.
function licences(): Plugin {
  return {
    name: 'licences',
    generateBundle(_, bundle) {
      const packages = new Set<string>();
      for (const file of Object.values(bundle)) {
        if (file.type !== 'chunk') continue;
        for (const [id, {renderedLength}] of Object.entries(file.modules)) {
          const name = /node_modules\/((?:@[^/]+\/)?[^/]+)\//.exec(id)?.[1];
          if (name && renderedLength > 0) packages.add(name);
        }
      }
      const parts = [...packages].sort().map((name) => {
        const folder = join('node_modules', name);
        const {version, license} = JSON.parse(readFileSync(join(folder, 'package.json'), 'utf8'));
        const file = readdirSync(folder).filter((one) => /^licen[sc]e/i.test(one)).sort()[0];
        const text = file && existsSync(join(folder, file)) ? readFileSync(join(folder, file), 'utf8').trim() : `(${license}; the package has no file of it)`;
        return `${name} ${version}: ${license}\n\n${text}\n`;
      });
      this.emitFile({type: 'asset', fileName: 'licences.txt', source: `The page is Apache-2.0, as all of Armature is. It contains these packages:\n\n${parts.join(`\n${'-'.repeat(100)}\n\n`)}`});
    },
  };
}

export default defineConfig({
  plugins: [licences(), oneFile()],
  build: {
    outDir: process.env.ARMATURE_BUNDLE_DIR ?? 'bundle',
    emptyOutDir: true,
    target: 'es2022',
    modulePreload: false,
    assetsInlineLimit: 1 << 20,
    chunkSizeWarningLimit: 2000,
    rollupOptions: {output: {inlineDynamicImports: true}},
  },
});
