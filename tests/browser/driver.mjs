// Drives Chromium for tests/browser.rs: one JSON command a line on the standard input, one JSON answer a line on the standard
// output. `node driver.mjs MODULES CHROMIUM MODE FONTS SITE` with the folder that holds playwright-core, the browser's program, one
// of the modes below, `system` or `latin` for the fonts it finds, and the folder of the page, which web/serve.mjs serves.

import { spawn } from "node:child_process";
import { once } from "node:events";
import { createRequire } from "node:module";
import { mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { basename, dirname, join } from "node:path";
import { createInterface } from "node:readline";
import { fileURLToPath } from "node:url";

const [modules, executablePath, mode, fonts, site] = process.argv.slice(2);
const { chromium } = createRequire(join(modules, "x.js"))("playwright-core");

const SERVER = join(dirname(fileURLToPath(import.meta.url)), "../../web/serve.mjs");
const COMMON = ["--no-sandbox", "--disable-background-networking", "--disable-component-update", "--disable-sync", "--no-first-run",
  "--disable-quic", "--host-resolver-rules=MAP lan.test 127.0.0.1"];
const MODES = {
  // WebGPU on a software adapter.
  webgpu: ["--enable-unsafe-webgpu", "--use-webgpu-adapter=swiftshader", "--enable-features=Vulkan", "--use-vulkan=swiftshader",
    "--use-angle=swiftshader"],
  // There is navigator.gpu, but it has no adapter.
  webgl: ["--use-angle=swiftshader", "--enable-unsafe-swiftshader"],
  // Nothing draws in three dimensions.
  neither: ["--disable-3d-apis"],
};
// A system without fonts for Chinese: it has one for Latin letters, as a browser cannot start without any.
const LATIN = `<?xml version="1.0"?><!DOCTYPE fontconfig SYSTEM "fonts.dtd"><fontconfig>
<dir>/usr/share/fonts/truetype/dejavu</dir><cachedir>CACHE</cachedir></fontconfig>`;

const folder = mkdtempSync(join(tmpdir(), "bdpt-browser-"));
const env = { ...process.env };
if (fonts === "latin") {
  env.FONTCONFIG_FILE = join(folder, "fonts.conf");
  writeFileSync(env.FONTCONFIG_FILE, LATIN.replace("CACHE", join(folder, "cache")));
}
const browser = await chromium.launch({ executablePath, args: [...COMMON, ...MODES[mode]], env });

// The page's server, at the root or below a path.
const servers = [];
async function serve({ prefix }) {
  const server = spawn(process.execPath, [SERVER, site, "--prefix", prefix], { stdio: ["ignore", "pipe", "inherit"] });
  servers.push(server);
  const line = await Promise.race([once(createInterface({ input: server.stdout }), "line"), once(server, "exit").then(() => [])]);
  if (line[0] === undefined) throw new Error("the page's server does not start");
  return line[0].trim();
}

let context, page, problems = [], requests = [];

// A new page in a browser that knows nothing yet; what goes wrong in it is noted.
async function open({ url, width, height, phone, locale, init, scale }) {
  await context?.close();
  [problems, requests] = [[], []];
  const touch = phone ? { hasTouch: true, isMobile: true } : {};
  context = await browser.newContext({ viewport: { width, height }, deviceScaleFactor: scale ?? 1, locale: locale ?? "en-US",
    colorScheme: "dark", reducedMotion: "no-preference", acceptDownloads: true, ...touch });
  // Where it plays a telephone, Chromium gives this as if a point had one pixel; the program then does as in browsers that lack it.
  if (phone) await context.addInitScript("delete ResizeObserverEntry.prototype.devicePixelContentBoxSize");
  for (const script of init ?? []) await context.addInitScript(script);
  page = await context.newPage();
  page.setDefaultTimeout(60000);
  page.on("console", message => message.type() === "error" && problems.push(`console: ${message.text()}`));
  page.on("pageerror", error => problems.push(`error: ${error}`));
  page.on("crash", () => problems.push("the page crashed"));
  page.on("response", answer => answer.status() >= 400 && problems.push(`${answer.status()} ${answer.url()}`));
  context.on("request", request => requests.push({ url: request.url(), method: request.method(), bytes: request.postDataBuffer()?.length ?? 0 }));
  await page.goto(url);
}

// Files as a person drops them on the canvas.
async function drop({ files, selector }) {
  const list = files.map(path => ({ name: basename(path), bytes: readFileSync(path).toString("base64") }));
  const transfer = await page.evaluateHandle(async list => {
    const transfer = new DataTransfer();
    for (const { name, bytes } of list) {
      const data = Uint8Array.from(atob(bytes), letter => letter.charCodeAt(0));
      transfer.items.add(new File([data], name));
    }
    return transfer;
  }, list);
  for (const type of ["dragenter", "dragover", "drop"]) await page.dispatchEvent(selector, type, { dataTransfer: transfer });
}

// Does something that makes the page offer a file, and keeps that file.
async function download(how) {
  const [offer] = await Promise.all([page.waitForEvent("download"), act(how.then)]);
  const path = join(how.folder, offer.suggestedFilename());
  await offer.saveAs(path);
  return path;
}

// Does something that asks for files, and gives them.
async function choose(how) {
  const [chooser] = await Promise.all([page.waitForEvent("filechooser"), act(how.then)]);
  await chooser.setFiles(how.files);
}

// Fingers on the screen, as the browser itself sees them: each step is where they are; after the last one they are gone.
async function fingers({ steps }) {
  const session = await context.newCDPSession(page);
  const send = (type, points) => session.send("Input.dispatchTouchEvent", { type, touchPoints: points.map(([x, y], id) => ({ x, y, id })) });
  for (const [index, points] of steps.entries()) {
    await send(index === 0 ? "touchStart" : "touchMove", points);
    await page.waitForTimeout(40);
  }
  await send("touchEnd", []);
  await session.detach();
}

async function act(command) {
  const { x, y } = command;
  switch (command.do) {
    case "serve": return serve(command);
    case "open": return open(command);
    case "wait": return (await page.waitForFunction(command.script, undefined, { timeout: command.timeout ?? 60000, polling: 50 })).jsonValue();
    case "eval": return page.evaluate(command.script);
    case "move": return page.mouse.move(x, y);
    case "click":
      // A person's pointer is there before it clicks; a click takes longer than a frame.
      await page.mouse.move(x, y);
      await page.waitForTimeout(60);
      return page.mouse.click(x, y, { delay: 60, ...command.options });
    case "tap": return page.touchscreen.tap(x, y);
    case "fingers": return fingers(command);
    case "press": return page.keyboard.press(command.key, { delay: 60 });
    case "shot": return void await page.screenshot({ path: command.path, clip: command.clip ?? undefined });
    case "drop": return drop(command);
    case "download": return download(command);
    case "choose": return choose(command);
    case "sleep": return page.waitForTimeout(command.ms);
    case "problems": return problems.splice(0);
    case "requests": return requests;
    case "close": return void (await context?.close(), context = undefined);
    default: throw new Error(`no such command: ${command.do}`);
  }
}

// Nobody waits for an answer any more: the browser goes, too.
const end = async () => {
  await browser.close();
  servers.forEach(server => server.kill());
  rmSync(folder, { recursive: true, force: true });
};
process.stdout.on("error", () => end().finally(() => process.exit(1)));
process.stdout.write(`${JSON.stringify({ ok: "ready" })}\n`);
for await (const line of createInterface({ input: process.stdin })) {
  let answer;
  try {
    answer = { ok: await act(JSON.parse(line)) ?? null };
  } catch (error) {
    answer = { error: String(error.stack ?? error) };
  }
  process.stdout.write(`${JSON.stringify(answer)}\n`);
}
await end();
