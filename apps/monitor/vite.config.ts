// SPDX-License-Identifier: Apache-2.0
// Builds bundle/index.html: one file with its script and style in it, that loads nothing. The same
// sources give the same bytes.
import {createHash} from 'node:crypto';
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

export default defineConfig({
  plugins: [oneFile()],
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
