// The page is built into the crate that serves it, under fixed names: the same sources give the same bytes, which CI checks.
export default {
  publicDir: "public",
  build: {
    outDir: "../crates/studio/assets",
    emptyOutDir: true,
    target: "es2022",
    modulePreload: false,
    cssCodeSplit: false,
    assetsInlineLimit: 0,
    rollupOptions: {
      output: {
        entryFileNames: "studio.js",
        chunkFileNames: "studio-[name].js",
        assetFileNames: "studio[extname]",
        inlineDynamicImports: true,
      },
    },
  },
};
