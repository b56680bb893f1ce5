import { defineConfig } from "vite";

/** Three scripts: the frame with the public pages (a phone loads no more), the instructor's pages, the plotting library; and two a language. */
function chunk_of(id: string): string | undefined {
  const language = /\/(words|language)\/(\w+)\.json/.exec(id);
  if (language) return `${language[1]}-${language[2]}`;
  if (id.includes("/node_modules/uplot/")) return "uplot";
  if (/\/src\/(plots|replay|manage)\/|\/src\/ui\/(table|dialog)\./.test(id)) return "instructor";
  if (/\/src\/pages\/(login|questionnaire|not_found)\.|\/src\/(lib|ui|words|session)/.test(id)) return "frame";
  return id.includes("/src/pages/") ? "instructor" : undefined;
}

// The page is served by `trocar serve`, which sends index.html for every path without a file ending.
export default defineConfig({
  base: "/",
  build: {
    outDir: "../data/web",
    emptyOutDir: true,
    target: "es2021",
    sourcemap: false,
    assetsInlineLimit: 0,
    modulePreload: { polyfill: false },
    reportCompressedSize: false,
    rollupOptions: { output: { manualChunks: chunk_of } },
  },
});
