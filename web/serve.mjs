#!/usr/bin/env node
// Serves a folder over HTTP, for a look at the built page: node web/serve.mjs DIR [--port N] [--prefix /some/path] [--host H].
// The first line it prints is the page's address. Without --port it takes a free port; without --host only this machine is
// answered (--host 0.0.0.0 answers a whole local network, where browsers give no WebGPU, as it is no secure context).

import { createReadStream, existsSync, readFileSync, statSync } from "node:fs";
import { createServer } from "node:http";
import { extname, join, normalize, resolve, sep } from "node:path";
import { parseArgs } from "node:util";
import { gzipSync } from "node:zlib";

const TYPES = {
  ".html": "text/html; charset=utf-8",
  ".js": "text/javascript; charset=utf-8",
  ".mjs": "text/javascript; charset=utf-8",
  ".css": "text/css; charset=utf-8",
  ".json": "application/json",
  ".txt": "text/plain; charset=utf-8",
  ".wasm": "application/wasm",
  ".svg": "image/svg+xml",
  ".png": "image/png",
  ".otf": "font/otf",
};
/** Names that change with the content never grow old. */
const HASHED = /-[0-9a-f]{16}\.\w+$/;

function options() {
  const known = { port: { type: "string", default: "0" }, prefix: { type: "string", default: "" }, host: { type: "string", default: "127.0.0.1" } };
  const { values, positionals } = parseArgs({ options: known, allowPositionals: true });
  const port = Number(values.port);
  const prefix = encodeURI(values.prefix.replace(/^\/*/, "/").replace(/\/+$/, ""));
  if (positionals.length !== 1 || !Number.isInteger(port) || port < 0 || port > 65535) {
    throw new Error("usage: node web/serve.mjs DIR [--port N] [--prefix /some/path] [--host H]");
  }
  const folder = resolve(positionals[0]);
  if (!existsSync(join(folder, "index.html"))) {
    throw new Error(`${folder} holds no index.html: build the page first (node web/build.mjs)`);
  }
  return { folder, port, prefix, host: values.host };
}

/** The file a request asks for; undefined if there is none. */
function find(folder, prefix, url) {
  const whole = new URL(url, "http://localhost").pathname;
  if (!whole.startsWith(`${prefix}/`)) return undefined;
  let path;
  try {
    path = decodeURIComponent(whole.slice(prefix.length));
  } catch {
    return undefined;
  }
  if (path.includes("\0")) return undefined;
  const file = normalize(join(folder, path, path.endsWith("/") ? "index.html" : ""));
  return file.startsWith(folder + sep) && existsSync(file) && statSync(file).isFile() ? file : undefined;
}

const zipped = new Map();
/** A file's content, compressed once. */
function zip(file) {
  const key = `${file} ${statSync(file).mtimeMs}`;
  if (!zipped.has(key)) zipped.set(key, gzipSync(readFileSync(file)));
  return zipped.get(key);
}

function answer(request, response, { folder, prefix }) {
  const path = new URL(request.url, "http://localhost").pathname;
  if (path === prefix && prefix !== "") {
    response.writeHead(301, { Location: `${prefix}/` }).end();
    return;
  }
  if (request.method !== "GET" && request.method !== "HEAD") {
    response.writeHead(405, { Allow: "GET, HEAD" }).end();
    return;
  }
  const file = find(folder, prefix, request.url);
  if (file === undefined) {
    response.writeHead(404, { "Content-Type": "text/plain; charset=utf-8" }).end("Not found.\n");
    return;
  }
  const type = TYPES[extname(file)] ?? "application/octet-stream";
  const headers = {
    "Content-Type": type,
    "Cache-Control": HASHED.test(file) ? "public, max-age=31536000, immutable" : "no-cache",
    Vary: "Accept-Encoding",
  };
  if (/\bgzip\b/.test(request.headers["accept-encoding"] ?? "") && !type.startsWith("image/png")) {
    const body = zip(file);
    response.writeHead(200, { ...headers, "Content-Encoding": "gzip", "Content-Length": body.length });
    response.end(request.method === "HEAD" ? undefined : body);
    return;
  }
  response.writeHead(200, { ...headers, "Content-Length": statSync(file).size });
  if (request.method === "HEAD") response.end();
  else createReadStream(file).on("error", () => response.destroy()).pipe(response);
}

try {
  const chosen = options();
  const server = createServer((request, response) => {
    try {
      answer(request, response, chosen);
    } catch (error) {
      response.writeHead(400).end(`${error.message}\n`);
    }
  });
  server.on("error", (error) => {
    console.error(error.message);
    process.exit(1);
  });
  server.listen(chosen.port, chosen.host, () => {
    const name = chosen.host === "127.0.0.1" ? "localhost" : chosen.host;
    console.log(`http://${name}:${server.address().port}${chosen.prefix}/`);
  });
} catch (error) {
  console.error(error.message);
  process.exit(2);
}
