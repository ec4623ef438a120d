// Play, pause, and the slider from the flat sheet to the first contact.

import { svg } from "./pattern.js";

const SECONDS = 3.2;
const PLAY = "M3 1.5v13l11-6.5z", PAUSE = "M3 2h3.6v12H3zM9.4 2H13v12H9.4z";
const ENDINGS = {
  contact: "first contact", "flat-fold": "a fold closes", node: "another motion crosses",
  singular: "followed no further", return: "flat again", angle: "angle reached", length: "end",
};

export function createTransport(store) {
  const slider = document.getElementById("time");
  const play = document.getElementById("play");
  const icon = svg("path");
  play.append(svg("svg", { viewBox: "0 0 16 16", "aria-hidden": "true" }, icon));
  let last = 0, forward = true;

  function step(now) {
    const { playing, time, speed } = store.get();
    if (!playing) return;
    const by = (speed * Math.min((now - last) / 1000, 0.1)) / SECONDS;
    last = now;
    let next = time + (forward ? by : -by);
    if (next >= 1 || next <= 0) {
      next = Math.min(Math.max(next, 0), 1);
      forward = next <= 0;
    }
    store.set({ time: next });
    requestAnimationFrame(step);
  }

  function toggle() {
    const { playing, time } = store.get();
    if (document.getElementById("transport").hidden) return;
    if (!playing) forward = time < 1;
    store.set({ playing: !playing });
  }

  slider.addEventListener("input", () => store.set({ time: slider.value / 1000, playing: false }));
  play.addEventListener("click", toggle);
  document.getElementById("speed").addEventListener("change", ({ target }) => store.set({ speed: Number(target.value) }));
  store.on(["playing"], ({ playing }) => {
    paint(playing);
    if (!playing) return;
    last = performance.now();
    requestAnimationFrame(step);
  });
  store.on(["time"], ({ time }) => (slider.value = Math.round(time * 1000)));

  function paint(playing) {
    icon.setAttribute("d", playing ? PAUSE : PLAY);
    play.setAttribute("aria-label", playing ? "Pause" : "Play");
    play.title = playing ? "Pause (space)" : "Play (space)";
  }

  function describe(motion, closed = false) {
    document.getElementById("transport").hidden = !motion;
    if (!motion && store.get().playing) store.set({ playing: false });
    slider.value = motion ? Math.round(store.get().time * 1000) : 0;
    document.getElementById("ending").textContent = closed ? "folded flat" : motion ? ENDINGS[motion.end] ?? motion.end : "";
    const ticks = (motion?.events ?? []).filter(({ time }) => time < motion.duration * 0.999).map(({ time }) => {
      const tick = document.createElement("i");
      tick.style.left = `${(100 * time) / motion.duration}%`;
      return tick;
    });
    document.getElementById("ticks").replaceChildren(...ticks);
  }

  function angle(degrees) {
    const text = degrees === null ? "" : `${Math.round(degrees)}°`;
    document.getElementById("angle").textContent = text;
    slider.setAttribute("aria-valuetext", text ? `largest fold angle ${text.replace("°", " degrees")}` : "flat");
  }

  paint(false);
  return { toggle, describe, angle };
}
