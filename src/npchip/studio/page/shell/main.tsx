/** Starts the page. */

import "./hook";
import { render } from "preact";
import { App } from "./app";
import { boot } from "./boot";
import { listen } from "./keys";

boot();
listen();
const place = document.getElementById("studio");
if (place) render(<App />, place);
