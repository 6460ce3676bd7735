/** A live camera: its newest picture as luma of the sensor's size, as often as the chip takes one. */

import { checkCanvas } from "./browser";
import { type Fit, FramesError, type Size } from "./errors";
import { averageAreas, sameSize } from "./fit";
import { lumaOfPixels, type Picture } from "./luma";

/** Longest side that is asked of a camera. */
const LONGEST = 640;
/** Longest side that is read of its picture: the sensor's pixels still average over several. */
const READ = 320;
/** Frames whose latencies are kept for the figures. */
const KEPT = 120;

export interface CameraOptions {
  /** One of `listCameras`; any camera without. */
  deviceId?: string;
  /**
   * Decision: `crop` cuts the picture's centre to the sensor's shape before areas are averaged, so
   * that nothing is distorted; `resize` averages the whole picture. A cut of 64 x 80 pixels, as
   * `crop` makes of files, would show a spot.
   */
  fit?: Fit;
  /** Called twice a second. */
  onStats?(stats: CameraStats): void;
  /** Called once if the camera ends by itself. */
  onEnd?(error: FramesError): void;
}

export interface CameraStats {
  /** Pictures that the camera gave, and that the chip completed, a second. */
  given: number;
  processed: number;
  /** Pictures since the start that were completed, and that the chip had no time for. */
  count: number;
  dropped: number;
  /** Milliseconds from the capture of a picture to its result: mean and worst of the last ones. */
  latency: number;
  worst: number;
}

export interface Camera {
  label: string;
  stats(): CameraStats;
  stop(): void;
}

/** Takes a frame; resolves when its result can be shown. `captured` is on the page's clock. */
export type TakeFrame = (frame: Uint8Array<ArrayBuffer>, captured: number) => Promise<unknown>;

/** List the cameras. Their names are known only once the reader has allowed one. */
export async function listCameras(): Promise<{ deviceId: string; label: string }[]> {
  const devices = (await navigator.mediaDevices?.enumerateDevices()) ?? [];
  return devices
    .filter(({ kind }) => kind === "videoinput")
    .map(({ deviceId, label }, index) => ({ deviceId, label: label || `Camera ${index + 1}` }));
}

/** Open a camera. Call it on the reader's click only, never for a link or by itself. */
export async function openCamera(
  size: Size,
  onFrame: TakeFrame,
  options: CameraOptions = {},
): Promise<Camera> {
  checkCanvas("camera");
  const stream = await openStream(options.deviceId);
  const video = document.createElement("video");
  video.muted = true;
  video.playsInline = true;
  video.srcObject = stream;
  try {
    await video.play();
  } catch {
    stop(stream);
    throw cameraError("the camera gives no picture", "Choose another camera, or plug it in again");
  }
  return new Live(size, onFrame, options, stream, video);
}

class Live implements Camera {
  readonly label: string;
  private readonly reader: Reader;
  private ended = false;
  private busy = false;
  /** Capture time of a picture that came while the chip was busy. */
  private waiting: number | null = null;
  private readonly latencies: number[] = [];
  private readonly given = new Meter();
  private readonly done = new Meter();
  private count = 0;
  private dropped = 0;
  private presented = 0;
  private readonly timer: ReturnType<typeof setInterval>;

  constructor(
    size: Size,
    private readonly onFrame: TakeFrame,
    private readonly options: CameraOptions,
    private readonly stream: MediaStream,
    private readonly video: HTMLVideoElement,
  ) {
    const track = stream.getVideoTracks()[0]!;
    this.label = track.label || "Camera";
    this.reader = new Reader(video, size, options.fit ?? "crop");
    track.addEventListener("ended", () => {
      this.end(cameraError("the camera has gone", "Plug it in again, then choose Camera again"));
    });
    this.timer = setInterval(() => options.onStats?.(this.stats()), 500);
    this.await();
  }

  stats(): CameraStats {
    const sum = this.latencies.reduce((all, one) => all + one, 0);
    return {
      given: this.given.rate(),
      processed: this.done.rate(),
      count: this.count,
      dropped: this.dropped,
      latency: this.latencies.length ? sum / this.latencies.length : 0,
      worst: Math.max(0, ...this.latencies),
    };
  }

  stop(): void {
    if (this.ended) return;
    this.ended = true;
    clearInterval(this.timer);
    stop(this.stream);
    this.video.srcObject = null;
  }

  private end(error: FramesError): void {
    if (this.ended) return;
    this.stop();
    this.options.onEnd?.(error);
  }

  /** Wait for the next picture of the camera. */
  private await(): void {
    if (this.ended) return;
    if ("requestVideoFrameCallback" in this.video) {
      this.video.requestVideoFrameCallback((now, data) => {
        const missed = this.presented ? data.presentedFrames - this.presented - 1 : 0;
        this.presented = data.presentedFrames;
        this.arrived(data.captureTime ?? now, Math.max(missed, 0));
        this.await();
      });
      return;
    }
    const before = this.presented; // in microseconds here, as nothing else tells pictures apart
    requestAnimationFrame((now) => {
      this.presented = Math.round(1e6 * this.video.currentTime);
      if (this.presented !== before) this.arrived(now, 0);
      this.await();
    });
  }

  private arrived(captured: number, missed: number): void {
    if (this.ended) return;
    this.given.count(1 + missed);
    this.dropped += missed;
    if (this.busy) {
      if (this.waiting !== null) this.dropped++;
      this.waiting = captured;
    } else this.process(captured);
  }

  private process(captured: number): void {
    let frame: Uint8Array<ArrayBuffer>;
    try {
      frame = this.reader.read();
    } catch {
      const help = "Choose Camera again, or another camera";
      this.end(cameraError("its picture cannot be read", help));
      return;
    }
    this.busy = true;
    const finish = (complete: boolean): void => {
      this.busy = false;
      if (complete) this.note(captured);
      else this.dropped++;
      const next = this.waiting;
      this.waiting = null;
      if (next !== null && !this.ended) this.process(next);
    };
    this.onFrame(frame, captured).then(
      (answer) => finish(answer !== "dropped"),
      () => finish(false), // who takes the frames tells of its own mistakes
    );
  }

  private note(captured: number): void {
    this.count++;
    this.done.count(1);
    this.latencies.push(performance.now() - captured);
    if (this.latencies.length > KEPT) this.latencies.shift();
  }
}

/** Reads the newest picture of a video as luma of the sensor's size. */
class Reader {
  private readonly context: OffscreenCanvasRenderingContext2D;

  constructor(
    private readonly video: HTMLVideoElement,
    private readonly size: Size,
    private readonly fit: Fit,
  ) {
    const context = new OffscreenCanvas(1, 1).getContext("2d", { willReadFrequently: true });
    if (!context) throw cameraError("the browser gives no canvas to read it", "Use another browser");
    this.context = context;
  }

  read(): Uint8Array<ArrayBuffer> {
    const { videoWidth, videoHeight } = this.video;
    const whole = { rows: videoHeight, cols: videoWidth };
    const part = this.fit === "crop" ? centre(whole, this.size) : whole;
    const scale = Math.min(1, READ / Math.max(part.rows, part.cols));
    const rows = Math.max(1, Math.round(part.rows * scale));
    const cols = Math.max(1, Math.round(part.cols * scale));
    const { canvas } = this.context;
    if (canvas.width !== cols) canvas.width = cols;
    if (canvas.height !== rows) canvas.height = rows;
    const [left, top] = [(whole.cols - part.cols) >> 1, (whole.rows - part.rows) >> 1];
    this.context.drawImage(this.video, left, top, part.cols, part.rows, 0, 0, cols, rows);
    const { data } = this.context.getImageData(0, 0, cols, rows);
    const picture: Picture = { rows, cols, data: lumaOfPixels(data, false) };
    return (sameSize(picture, this.size) ? picture : averageAreas(picture, this.size)).data;
  }
}

/** Return the largest size of the sensor's shape within a picture. */
export function centre(whole: Size, size: Size): Size {
  if (whole.cols * size.rows > whole.rows * size.cols) {
    return { rows: whole.rows, cols: Math.round((whole.rows * size.cols) / size.rows) };
  }
  return { rows: Math.round((whole.cols * size.rows) / size.cols), cols: whole.cols };
}

/** Counts events of the last two seconds. */
class Meter {
  private readonly times: number[] = [];
  private readonly start = performance.now();

  count(events: number): void {
    const now = performance.now();
    for (let event = 0; event < events; event++) this.times.push(now);
    this.forget(now);
  }

  rate(): number {
    const now = performance.now();
    this.forget(now);
    return (1000 * this.times.length) / Math.min(2000, Math.max(now - this.start, 1));
  }

  private forget(now: number): void {
    while (this.times.length && this.times[0]! < now - 2000) this.times.shift();
  }
}

async function openStream(deviceId: string | undefined): Promise<MediaStream> {
  if (!window.isSecureContext || !navigator.mediaDevices?.getUserMedia) {
    const help = "Open the page from https, from 127.0.0.1 (npchip studio), or as a file";
    throw cameraError("browsers give no camera to a page from an insecure address", help);
  }
  const video: MediaTrackConstraints = {
    width: { ideal: LONGEST },
    height: { ideal: 480 },
    frameRate: { ideal: 30 },
  };
  if (deviceId) video.deviceId = { exact: deviceId };
  try {
    return await navigator.mediaDevices.getUserMedia({ video, audio: false });
  } catch (error) {
    throw refusal(error);
  }
}

/** Say what a refusal means and what mends it. */
function refusal(error: unknown): FramesError {
  const name = error instanceof Error ? error.name : "";
  switch (name) {
    case "NotAllowedError":
    case "SecurityError":
      return cameraError(
        "the camera was refused",
        "Allow it beside the page's address or in the system's privacy settings, then choose Camera again",
      );
    case "NotFoundError":
    case "OverconstrainedError":
      return cameraError("there is no such camera", "Plug one in, or choose another one");
    case "NotReadableError":
    case "AbortError":
      return cameraError(
        "the camera cannot be opened; another program may use it",
        "Close programs that show its picture, then choose Camera again",
      );
    default:
      return cameraError(
        `the camera cannot be opened${error instanceof Error ? `: ${error.message}` : ""}`,
        "Choose another camera, or open a clip",
      );
  }
}

function cameraError(what: string, help: string): FramesError {
  return new FramesError("NP211", `camera: ${what}`, help);
}

function stop(stream: MediaStream): void {
  for (const track of stream.getTracks()) track.stop();
}
