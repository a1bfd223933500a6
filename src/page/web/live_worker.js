// The worker of a page that simulates: the reference solver as WebAssembly (src/live/exports.cpp), image after image.
"use strict";
let wasm, size, plan = [], step = 0, generation = 0, steps = 0, spent = 0;
const again = new MessageChannel();  // between two slices of work the worker hears what it is told

const answer = () => new TextDecoder().decode(new Uint8Array(wasm.memory.buffer, wasm.answer() >>> 0, wasm.answer_size()));
function give(text) {
  const bytes = new TextEncoder().encode(text), at = wasm.text(bytes.length) >>> 0;
  new Uint8Array(wasm.memory.buffer).set(bytes, at);
}
const numbers = () => new Float32Array(wasm.memory.buffer, wasm.numbers() >>> 0, size);

// What the module asks of a system, it does without: none of it is needed to compute.
async function load(deflated) {
  const stream = new Blob([deflated]).stream().pipeThrough(new DecompressionStream("deflate-raw"));
  const module = await WebAssembly.compile(await new Response(stream).arrayBuffer()), imports = {};
  for (const { module: of, name } of WebAssembly.Module.imports(module)) {
    imports[of] ??= {};
    imports[of][name] = () => { const unknown = 52; return unknown; };
  }
  wasm = (await WebAssembly.instantiate(module, imports)).exports;
  wasm._initialize();
}

function known(refused) {
  const { particles, balls, ...facts } = JSON.parse(answer());
  size = 6 * particles + 9 * balls;
  postMessage({ generation, refused, facts });
}

// Messages: create {text, plan, state?} with a scene's TOML, change {text, inputs, plan, state} with lines KEY=VALUE; a state is {step, numbers}.
const commands = {
  load: ({ deflated }) => load(deflated),
  create({ text, state }) {
    give(text);
    if (wasm.create() !== 0) throw new Error(answer());
    known();
    step = 0;
    if (state) enter(state);
  },
  change({ text, inputs, state }) {
    enter(state);
    new Float64Array(wasm.memory.buffer, wasm.inputs(inputs.length) >>> 0, inputs.length).set(inputs);
    give(text);
    const refused = wasm.change() !== 0 ? answer() : undefined;
    if (refused) give("");
    if (refused) wasm.change();
    known(refused);
  },
};

function enter(state) {
  numbers().set(state.numbers);
  if (wasm.load(state.step) !== 0) throw new Error(answer());
  step = state.step;
}

function image() {
  if (wasm.take() !== 0) throw new Error(answer());
  const measured = JSON.parse(answer()), copy = numbers().slice();
  postMessage({ generation, ...measured, numbers: copy, steps, spent }, [copy.buffer]);
  return measured.step;
}

// Some 25 ms of work. It ends with the plan, or with a divergence, which shows the last good state.
function work() {
  const begun = performance.now();
  let perStep = 0;
  while (plan.length > 0) {
    const from = performance.now(), count = Math.min(plan[0] - step, perStep > 0 ? Math.max(1, Math.floor(10 / perStep)) : 1);
    if (count > 0) {
      const code = wasm.advance(count), took = performance.now() - from;
      if (code === 1) throw new Error(answer());
      if (code === 2) {
        const said = answer();
        image();
        plan = [];
        postMessage({ generation, diverged: said });
        return;
      }
      perStep = took / count;
      step += count;
      steps += count;
      spent += took;
    }
    if (step === plan[0]) {
      image();
      plan.shift();
    }
    if (plan.length > 0 && performance.now() - begun > 25) {
      again.port2.postMessage(generation);
      return;
    }
  }
  postMessage({ generation, done: true });
}

function guarded(act) {
  try {
    act();
  } catch (error) {
    plan = [];
    postMessage({ generation, failed: error.message });
  }
}

again.port1.onmessage = ({ data }) => { if (data === generation) guarded(work); };
let ready = Promise.resolve();
onmessage = ({ data }) => {
  ready = ready.then(async () => {
    generation = data.generation;
    plan = [];
    try {
      await commands[data.command](data);
    } catch (error) {
      postMessage({ generation, failed: error.message });
      return;
    }
    if (data.plan) {
      plan = data.plan;
      guarded(work);
    }
  });
};
