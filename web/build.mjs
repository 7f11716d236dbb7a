#!/usr/bin/env node
// Builds the page: node web/build.mjs [--out DIR] [--debug]
//
// It needs a Rust compiler with the target wasm32-unknown-unknown (`rustup target add wasm32-unknown-unknown`, or Debian's
// rustc-web, cargo-web, rust-web-src and lld-22), Node 18 or newer with npm, and for the first time a network: wasm-bindgen and
// wasm-opt are fetched into target/tools. What it makes is a folder of plain files that any static host serves from any path.
// It fails if the code grows beyond what a phone on a slow line should load.

import { execFileSync } from "node:child_process";
import { createHash } from "node:crypto";
import { cpSync, existsSync, mkdirSync, readFileSync, readdirSync, rmSync, statSync, writeFileSync } from "node:fs";
import { dirname, join, resolve } from "node:path";
import { fileURLToPath } from "node:url";
import { parseArgs } from "node:util";
import { brotliCompressSync, constants, gzipSync } from "node:zlib";

const ROOT = resolve(dirname(fileURLToPath(import.meta.url)), "..");
const TARGET = resolve(process.env.CARGO_TARGET_DIR ?? join(ROOT, "target"));
const TOOLS = join(TARGET, "tools");
const TRIPLE = "wasm32-unknown-unknown";
const BINARYEN = "132.0.0";
/** The most that the code may weigh, compressed with brotli: 3.5 MB. */
const MOST = 3_500_000;
/** What the compiler may use, so that wasm-opt may: all browsers since 2023 know these. */
const FEATURES = ["bulk-memory", "bulk-memory-opt", "call-indirect-overlong", "multivalue", "mutable-globals", "nontrapping-float-to-int", "reference-types", "sign-ext", "simd"];

const { values: chosen } = parseArgs({ options: { out: { type: "string" }, debug: { type: "boolean", default: false } } });
const OUT = resolve(chosen.out ?? join(TARGET, "site"));
const started = Date.now();

/** Says what is being done, and after how long. */
function step(what) {
  console.log(`[${((Date.now() - started) / 1000).toFixed(0).padStart(4)} s] ${what}`);
}

function run(program, args, env = {}, options = {}) {
  execFileSync(program, args, { cwd: ROOT, stdio: "inherit", env: { ...process.env, ...env }, ...options });
}

/** What a program prints; undefined if it cannot be run. */
function ask(program, args) {
  try {
    return execFileSync(program, args, { cwd: ROOT, stdio: ["ignore", "pipe", "ignore"] }).toString();
  } catch {
    return undefined;
  }
}

/** The compiler to use: rustup's, or the one Debian maintains for browsers, with the sources of the standard library. */
function compiler() {
  if (ask("rustup", ["target", "list", "--installed"])?.split(/\s+/).includes(TRIPLE)) return { cargo: "cargo", args: [], env: {} };
  const bin = "/usr/bin";
  const linker = existsSync(bin) ? readdirSync(bin).filter((name) => /^wasm-ld-\d+$/.test(name)).sort((a, b) => parseInt(b.slice(8)) - parseInt(a.slice(8)))[0] : undefined;
  const sources = ask(`${bin}/rustc`, ["--print", "sysroot"])?.trim();
  if (linker !== undefined && sources !== undefined && existsSync(join(sources, "lib/rustlib/src/rust/library/std"))) {
    const env = { PATH: `${bin}:${process.env.PATH}`, RUSTC_BOOTSTRAP: "1", CARGO_TARGET_WASM32_UNKNOWN_UNKNOWN_LINKER: linker };
    return { cargo: `${bin}/cargo`, args: ["-Z", "build-std=std,panic_abort"], env };
  }
  if (existsSync(join(ask("rustc", ["--print", "sysroot"])?.trim() ?? "", "lib/rustlib", TRIPLE))) return { cargo: "cargo", args: [], env: {} };
  throw new Error(
    `there is no compiler for ${TRIPLE}. With rustup: rustup target add ${TRIPLE}\n` +
      "On Debian without it: apt-get install rustc-web cargo-web rust-web-src lld-22",
  );
}

/** The version of a package in Cargo.lock. */
function locked(name) {
  const found = readFileSync(join(ROOT, "Cargo.lock"), "utf8").match(new RegExp(`name = "${name}"\\nversion = "([^"]+)"`));
  if (found === null) throw new Error(`Cargo.lock does not name ${name}`);
  return found[1];
}

/** wasm-bindgen in the very version of the library. */
function bindgen() {
  const version = locked("wasm-bindgen");
  const root = join(TOOLS, `wasm-bindgen-${version}`);
  const program = join(root, "bin", process.platform === "win32" ? "wasm-bindgen.exe" : "wasm-bindgen");
  if (existsSync(program)) return program;
  if (ask("wasm-bindgen", ["--version"])?.trim().split(" ").pop() === version) return "wasm-bindgen";
  step(`wasm-bindgen ${version} is compiled once, into ${root}`);
  const env = { CARGO_TARGET_DIR: join(TOOLS, "build"), CARGO_PROFILE_RELEASE_DEBUG: "false" };
  run("cargo", ["install", "wasm-bindgen-cli", "--version", version, "--root", root, "--quiet"], env);
  rmSync(join(TOOLS, "build"), { recursive: true, force: true });
  return program;
}

/** wasm-opt, a script of the npm package binaryen. */
function optimiser() {
  const root = join(TOOLS, `binaryen-${BINARYEN}`);
  const script = join(root, "node_modules/binaryen/bin/wasm-opt");
  if (!existsSync(script)) {
    step(`wasm-opt (binaryen ${BINARYEN}) is fetched once, into ${root}`);
    mkdirSync(root, { recursive: true });
    // On Windows npm is a script, which only a shell runs; in the folder itself no path has to be quoted for it.
    const windows = process.platform === "win32";
    const options = { cwd: root, shell: windows };
    run(windows ? "npm.cmd" : "npm", ["install", "--prefix", ".", "--no-save", "--no-audit", "--no-fund", "--loglevel=error", `binaryen@${BINARYEN}`], {}, options);
  }
  return script;
}

/** Compiles; returns the wasm file. */
function compile() {
  const { cargo, args, env } = compiler();
  const profile = chosen.debug ? "dev" : "web";
  const folder = join(TARGET, "web");
  run(cargo, ["build", "--bin", "bdpt-explorer", "--target", TRIPLE, "--profile", profile, "--locked", ...args], {
    ...env,
    CARGO_TARGET_DIR: folder,
    CARGO_INCREMENTAL: "0",
    // Flags for every target, which a person may have set for their own machine, would be taken instead of these.
    RUSTFLAGS: undefined,
    CARGO_ENCODED_RUSTFLAGS: undefined,
    CARGO_TARGET_WASM32_UNKNOWN_UNKNOWN_RUSTFLAGS: "-C target-feature=+simd128",
  });
  return join(folder, TRIPLE, chosen.debug ? "debug" : "web", "bdpt-explorer.wasm");
}

const size = (bytes) => ({
  raw: bytes.length,
  gzip: gzipSync(bytes, { level: 9 }).length,
  brotli: brotliCompressSync(bytes, { params: { [constants.BROTLI_PARAM_QUALITY]: 11, [constants.BROTLI_PARAM_LGWIN]: 24 } }).length,
});

function line(name, { raw, gzip, brotli }) {
  const number = (n) => n.toLocaleString("en").padStart(12);
  console.log(`${name.padEnd(44)}${number(raw)}${number(gzip)}${number(brotli)}`);
}

/** Writes a file under a name that changes with its content; returns the name. */
function write(stem, extension, bytes) {
  const hash = createHash("sha256").update(bytes).digest("hex").slice(0, 16);
  const name = `${stem}-${hash}.${extension}`;
  writeFileSync(join(OUT, name), bytes);
  return name;
}

/** The page's files, in an empty folder. Only a folder that holds nothing but an earlier page is emptied. */
function empty() {
  const ours = (name) => /^(bdpt-explorer-[0-9a-f]{16}\.(js|wasm|otf)|index\.html|licences|\.nojekyll)$/.test(name);
  const foreign = existsSync(OUT) ? readdirSync(OUT).filter((name) => !ours(name)) : [];
  if (foreign.length > 0) throw new Error(`${OUT} holds other files than a page built before (${foreign[0]}): choose another folder with --out`);
  rmSync(OUT, { recursive: true, force: true });
  mkdirSync(join(OUT, "licences"), { recursive: true });
}

/** index.html: style and loader are in it, so that a failure of anything else can be told. */
function page(script, program, font, length) {
  const read = (name) => readFileSync(join(ROOT, "web", name), "utf8");
  const config = JSON.stringify({ script, program, length });
  const parts = { style: read("page.css"), texts: read("texts.js"), loader: read("loader.js"), config, font };
  return read("index.html").replace(/\{\{(\w+)\}\}/g, (_, name) => {
    if (!(name in parts)) throw new Error(`web/index.html asks for {{${name}}}`);
    return parts[name];
  });
}

function build() {
  const [bind, optimise] = [bindgen(), chosen.debug ? undefined : optimiser()];
  step(`the program is compiled (${chosen.debug ? "debug" : "optimised; this takes some minutes"})`);
  const compiled = compile();
  const bound = join(TARGET, "web", "bound");
  rmSync(bound, { recursive: true, force: true });
  step("wasm-bindgen");
  const names = chosen.debug ? ["--keep-debug"] : ["--remove-name-section", "--remove-producers-section"];
  run(bind, [compiled, "--out-dir", bound, "--out-name", "page", "--target", "web", "--no-typescript", ...names]);
  const bare = join(bound, "page_bg.wasm");
  const small = join(bound, "small.wasm");
  if (optimise !== undefined) {
    step("wasm-opt");
    const enable = FEATURES.map((feature) => `--enable-${feature}`);
    run(process.execPath, [optimise, bare, "-O3", "--strip-debug", "--strip-producers", ...enable, "-o", small]);
  }
  if (existsSync(join(bound, "snippets"))) throw new Error("a package brings scripts of its own (wasm-bindgen's snippets): web/build.mjs does not copy these yet");

  empty();
  const wasm = readFileSync(optimise === undefined ? bare : small);
  const program = write("bdpt-explorer", "wasm", wasm);
  const glue = readFileSync(join(bound, "page.js"));
  const script = write("bdpt-explorer", "js", glue);
  // The page has its own Chinese, too; a browser loads the font only where the system has none.
  const font = write("bdpt-explorer", "otf", readFileSync(join(ROOT, "assets/fonts/interface-zh.otf")));
  const html = page(script, program, font, wasm.length);
  writeFileSync(join(OUT, "index.html"), html);
  writeFileSync(join(OUT, ".nojekyll"), "");
  for (const name of ["LICENSE-APACHE", "LICENSE-MIT"]) cpSync(join(ROOT, name), join(OUT, "licences", name));
  cpSync(join(ROOT, "assets/fonts/OFL.txt"), join(OUT, "licences", "interface-zh-OFL.txt"));
  step(`the page is in ${OUT}`);
  report(statSync(compiled).size, statSync(bare).size, wasm, glue, html);
}

/** The sizes, and the gate. */
function report(compiled, bare, wasm, glue, html) {
  const assets = (folder, end) => Buffer.concat(readdirSync(join(ROOT, folder)).filter((name) => name.endsWith(end)).map((name) => readFileSync(join(ROOT, folder, name))));
  console.log(`\n${"bytes".padEnd(44)}${["raw", "gzip", "brotli"].map((name) => name.padStart(12)).join("")}`);
  const code = size(wasm);
  line("code (wasm, with the fonts and scenes in it)", code);
  line("  fonts in it (assets/fonts)", size(assets("assets/fonts", ".otf")));
  line("  scenes in it (assets)", size(assets("assets", ".glb")));
  line("script", size(glue));
  line("page (with style and loader)", size(Buffer.from(html)));
  console.log(`wasm before wasm-bindgen: ${compiled.toLocaleString("en")}; before wasm-opt: ${bare.toLocaleString("en")}`);
  if (!chosen.debug && code.brotli > MOST) throw new Error(`the code is ${code.brotli.toLocaleString("en")} bytes of brotli; at most ${MOST.toLocaleString("en")} are allowed`);
}

try {
  build();
} catch (error) {
  console.error(error.message);
  process.exit(1);
}
