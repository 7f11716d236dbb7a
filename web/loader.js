// Loads the program, shows how far that is, and tells on the page whatever goes wrong, now or later.
//
// The program calls `bdpt.ready()` when its first frame is on the screen, and `bdpt.fail(kind, detail)` when it cannot go on;
// whatever else ends it (a trap, an error of a script) is caught here. Only the first failure is told: what follows is its
// consequence. What does not end the program is left in `bdpt.notes`, for it to show; `bdpt.wake`, which it sets, tells it so.
const at = (id) => document.getElementById(id);
const chinese = (tag) => /^zh\b/i.test(tag ?? "");
document.documentElement.lang = chinese(navigator.languages?.[0] ?? navigator.language) ? "zh-Hans" : "en";
/** The page's texts in its language, which the program changes when a person does. */
const texts = () => TEXTS[chinese(document.documentElement.lang) ? "zh" : "en"];

let failed = false;
let running = false;
/** The program's memory, once it runs. */
let memory;

function fail(kind, detail) {
  if (failed) return;
  failed = true;
  const words = texts();
  const [title, what, todo] = words[kind];
  at("failure-title").textContent = title;
  at("failure-what").textContent = what;
  at("failure-do").textContent = todo;
  at("failure-again").textContent = words.again;
  at("failure-afresh").textContent = words.afresh;
  at("failure-more").textContent = words.more;
  const size = memory === undefined ? "" : `\nmemory: ${Math.round(memory.buffer.byteLength / 2 ** 20)} MiB`;
  at("failure-detail").textContent = `${detail}${size}\n${BUILT.program}\n${navigator.userAgent}`;
  at("failure").dataset.kind = kind;
  // What is left of the program rests from now on.
  document.documentElement.dataset.ended = kind;
  // A view that ends the program might do so again.
  at("failure-afresh").hidden = location.hash.length < 2;
  at("failure-again").onclick = () => again(kind, false);
  at("failure-afresh").onclick = () => again(kind, true);
  at("loading").hidden = true;
  at("stage").inert = true;
  at("failure").hidden = false;
  at("failure-again").focus();
}

/** Starts again, with what the server has now. */
async function again(kind, afresh) {
  if (afresh) history.replaceState(null, "", location.pathname + location.search);
  else if (kind === "memory" || kind === "trap") {
    try {
      sessionStorage.setItem("bdpt:restart", "half");
    } catch {
      // Then it starts as large as it was.
    }
  }
  await fetch(location.href, { cache: "reload" }).catch(() => undefined);
  location.reload();
}

/** Tells of an error that nobody has caught. */
function uncaught(error, text) {
  const detail = `${text ?? ""}${error?.stack ? `\n${error.stack}` : ""}`.trim() || String(error);
  if (error instanceof WebAssembly.RuntimeError || error instanceof RangeError) {
    // An allocation that fails ends in a trap, and says nothing.
    fail(memory !== undefined && memory.buffer.byteLength > 2 ** 30 ? "memory" : "trap", detail);
  } else if (running && !/\.wasm\b/.test(error?.stack ?? "")) {
    bdpt.note(text ?? String(error));
  } else {
    fail("script", detail);
  }
}

window.bdpt = {
  fail,
  ready() {
    running = true;
    at("loading").hidden = true;
  },
  notes: [],
  note(text) {
    bdpt.notes.push(text);
    bdpt.wake?.();
  },
};
window.addEventListener("error", (event) => {
  // A notice that sizes settle in the next frame, and errors of scripts that are not the page's (the browser's extensions).
  if (event.error instanceof Error) uncaught(event.error, event.message);
});
window.addEventListener("unhandledrejection", (event) => uncaught(event.reason, undefined));

class Failure extends Error {
  constructor(kind, detail) {
    super(detail);
    this.kind = kind;
  }
}

/** What the page's files say, or a failure that says why not. */
async function get(name) {
  const response = await fetch(name).catch((error) => {
    throw new Failure("network", `${name}: ${error}`);
  });
  if (response.status === 404 || response.status === 410) throw new Failure("stale", `${name}: ${response.status}`);
  if (!response.ok) throw new Failure("network", `${name}: ${response.status} ${response.statusText}`);
  return response;
}

/** Reads a response to its end and shows how far it is. (What is counted has been decompressed, as is the length.) */
async function follow(response) {
  const reader = response.body.getReader();
  const megabytes = (n) => (n / 1e6).toFixed(1);
  let have = 0;
  for (;;) {
    const { done, value } = await reader.read().catch((error) => {
      throw new Failure("network", `after ${have} of ${BUILT.length} bytes: ${error}`);
    });
    if (done) break;
    const magic = [0x00, 0x61, 0x73, 0x6d];
    if (have === 0 && value.length >= 4 && magic.some((byte, index) => value[index] !== byte)) {
      throw new Failure("server", `${BUILT.program} is ${response.headers.get("Content-Type") ?? "of no known type"}, not WebAssembly`);
    }
    have += value.length;
    at("loading-bar").value = Math.min(have / BUILT.length, 1);
    at("loading-text").textContent = texts().downloading.replace("{}", megabytes(have)).replace("{}", megabytes(BUILT.length));
  }
  if (have !== BUILT.length) throw new Failure("network", `${BUILT.program}: ${have} bytes instead of ${BUILT.length}`);
  at("loading-text").textContent = texts().starting;
}

/** Compiles while it is loaded. */
async function compile() {
  const response = await get(`./${BUILT.program}`);
  const followed = follow(response.clone());
  // A server that does not know the type is no reason to fail.
  const typed = /^application\/wasm\b/.test(response.headers.get("Content-Type") ?? "");
  const source = typed ? response : new Response(response.body, { headers: { "Content-Type": "application/wasm" } });
  const compiled = WebAssembly.compileStreaming(source).catch((error) => {
    if (error instanceof WebAssembly.CompileError) throw new Failure("old", String(error));
    throw new Failure("network", String(error));
  });
  // What is wrong with the download explains why it does not compile.
  compiled.catch(() => undefined);
  await followed;
  return compiled;
}

async function start() {
  if (typeof WebAssembly !== "object" || typeof WebAssembly.compileStreaming !== "function") {
    throw new Failure("old", "there is no WebAssembly.compileStreaming");
  }
  at("loading-text").textContent = texts().downloading.replace("{}", "0.0").replace("{}", (BUILT.length / 1e6).toFixed(1));
  const script = import(`./${BUILT.script}`).catch((error) => {
    throw new Failure("network", `${BUILT.script}: ${error}`);
  });
  script.catch(() => undefined);
  const module = await compile();
  const { default: init } = await script;
  const program = await init({ module_or_path: module });
  memory = program.memory;
}

// Where a browser's developer tools imitate a phone, sizes in device pixels are wrong: the program goes by the others then.
new ResizeObserver(([entry], observer) => {
  observer.disconnect();
  const given = entry.devicePixelContentBoxSize?.[0].inlineSize;
  const right = entry.contentBoxSize?.[0].inlineSize * devicePixelRatio;
  if (Math.abs(given - right) > 2) delete ResizeObserverEntry.prototype.devicePixelContentBoxSize;
}).observe(at("stage"));

start().catch((error) => (error instanceof Failure ? fail(error.kind, error.message) : uncaught(error, undefined)));
