// Time of a replay: play, pause, step. Frames of the display drive it; a listener sees every change.

export interface ReplayClock {
  readonly time_s: number;
  readonly duration_s: number;
  readonly is_playing: boolean;
  play: () => void;
  pause: () => void;
  set_time: (time_s: number) => void;
  set_speed: (factor: number) => void;
  on_change: (listener: () => void) => void;
}

export function make_clock(duration_s: number, signal: AbortSignal): ReplayClock {
  const listeners: (() => void)[] = [];
  let time_s = 0;
  let speed = 1;
  let is_playing = false;
  let last_frame_ms: number | null = null;
  const tell = (): void => listeners.forEach((one) => one());
  const frame = (now_ms: number): void => {
    if (!is_playing || signal.aborted) return;
    if (last_frame_ms !== null) time_s += ((now_ms - last_frame_ms) / 1000) * speed;
    last_frame_ms = now_ms;
    if (time_s >= duration_s) {
      time_s = duration_s;
      is_playing = false;
    } else {
      requestAnimationFrame(frame);
    }
    tell();
  };
  signal.addEventListener("abort", () => (is_playing = false));
  return {
    get time_s() {
      return time_s;
    },
    get is_playing() {
      return is_playing;
    },
    duration_s,
    play: () => {
      if (is_playing) return;
      if (time_s >= duration_s) time_s = 0;
      is_playing = true;
      last_frame_ms = null;
      requestAnimationFrame(frame);
      tell();
    },
    pause: () => {
      is_playing = false;
      tell();
    },
    set_time: (wished_s) => {
      time_s = Math.max(0, Math.min(duration_s, wished_s));
      tell();
    },
    set_speed: (factor) => {
      speed = factor;
    },
    on_change: (listener) => void listeners.push(listener),
  };
}
