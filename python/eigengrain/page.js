// What a page of eigengrain does: page.py fills in the data and three.js. Lengths are in half diagonals of what is shown,
// from its middle. Balls are squares that face the camera, on which the fragment shader hits a sphere: exact at any zoom, and
// two triangles each, so that 100,000 of them turn smoothly. All that moves in a mode moves in the vertex shader.
"use strict";
(async () => {
  const $ = (id) => document.getElementById(id);
  const data = JSON.parse($("data").textContent);
  const texts = [...document.querySelectorAll(".array")];
  const bytes = (k) => {
    const text = atob(texts[k].textContent), result = new Uint8Array(text.length);
    for (let i = 0; i < text.length; ++i) result[i] = text.charCodeAt(i);
    return result.buffer;
  };
  const floats = (k) => new Float32Array(bytes(k));
  const fail = (message) => {
    $("problem").hidden = false;
    $("problem").textContent = message;
    throw new Error(message);
  };

  // Modules from within the page: no server, no network.
  const module = (text) => URL.createObjectURL(new Blob([text], {type: "text/javascript"}));
  const three = module($("three").textContent);
  const THREE = await import(three);
  const {OrbitControls} = await import(module($("controls").textContent.replace(/from\s*'three'/, `from '${three}'`)));

  const view = $("view");
  if (!view.getContext("webgl2", {antialias: true})) fail("This browser shows no WebGL 2; try another one, or allow it in its settings.");
  const renderer = new THREE.WebGLRenderer({canvas: view, context: view.getContext("webgl2"), antialias: true});
  renderer.setPixelRatio(Math.min(window.devicePixelRatio, 2));
  const scene = new THREE.Scene();
  const camera = new THREE.PerspectiveCamera(35, 1, 0.01, 50);
  camera.up.set(0, 0, 1);
  const controls = new OrbitControls(camera, view);
  let wanted = true; // whether something has changed since the last picture
  controls.addEventListener("change", () => (wanted = true));

  const dark = window.matchMedia("(prefers-color-scheme: dark)");
  const ground = () => {
    scene.background = new THREE.Color(getComputedStyle(document.documentElement).getPropertyValue("--ground").trim());
    wanted = true;
  };
  dark.addEventListener("change", ground);

  const table = new Uint8Array(256 * 4);
  for (let k = 0; k < 256; ++k) table.set([...data.colours.slice(3 * k, 3 * k + 3), 255], 4 * k);
  const colours = new THREE.DataTexture(table, 256, 1);
  colours.minFilter = colours.magFilter = THREE.LinearFilter;
  colours.needsUpdate = true;

  // Balls
  const position = floats(data.position), radius = floats(data.radius), identity = new Int32Array(bytes(data.identity));
  const count = radius.length;
  const displacements = data.modes.map((mode) => floats(mode.displacement));
  const still = new Float32Array(3 * count);
  const shared = {
    colours: {value: colours}, swing: {value: 0}, shrink: {value: 1}, least: {value: 0},
    cut: {value: new THREE.Vector4(0, 0, 0, 1)}, // what lies beyond normal . x = w is not shown
  };
  const cutting = "bool beyond(vec3 x) { return dot(cut.xyz, x) > cut.w; }";
  const balls = new THREE.InstancedBufferGeometry();
  balls.setAttribute("position", new THREE.BufferAttribute(new Float32Array([-1, -1, 0, 1, -1, 0, 1, 1, 0, -1, 1, 0]), 3));
  balls.setIndex([0, 1, 2, 0, 2, 3]);
  balls.instanceCount = count;
  const column = new THREE.InstancedBufferAttribute(new Float32Array(count), 1);
  const motion = new THREE.InstancedBufferAttribute(displacements.length ? displacements[0].slice() : still, 3);
  balls.setAttribute("centre", new THREE.InstancedBufferAttribute(position, 3));
  balls.setAttribute("radius", new THREE.InstancedBufferAttribute(radius, 1));
  balls.setAttribute("motion", motion);
  balls.setAttribute("value", column);
  const ballMaterial = new THREE.ShaderMaterial({
    glslVersion: THREE.GLSL3, uniforms: shared, alphaToCoverage: true,
    vertexShader: `
      in vec3 centre; in vec3 motion; in float radius; in float value;
      uniform float swing; uniform float shrink; uniform float least; uniform vec4 cut;
      out vec3 at; out vec2 place; flat out vec3 middle; flat out float size; flat out float shade;
      ${cutting}
      void main() {
        size = radius * shrink;
        shade = value;
        middle = (modelViewMatrix * vec4(centre + swing * motion, 1.0)).xyz;
        // The outline of a sphere in perspective is larger than its radius.
        float away = length(middle), grown = size * away / sqrt(max(away * away - size * size, 1e-12));
        vec3 ahead = middle / away, right = normalize(cross(ahead, vec3(0.0, 1.0, 0.0)));
        place = position.xy * 1.03;
        at = middle + grown * (place.x * right + place.y * cross(right, ahead));
        gl_Position = beyond(centre) || value < least || size <= 0.0 || away <= size ? vec4(2.0, 2.0, 2.0, 1.0) : projectionMatrix * vec4(at, 1.0);
      }`,
    fragmentShader: `
      precision highp float;
      in vec3 at; in vec2 place; flat in vec3 middle; flat in float size; flat in float shade;
      uniform sampler2D colours; uniform mat4 projectionMatrix;
      layout(location = 0) out vec4 colour;
      void main() {
        float out2 = length(place), soft = max(fwidth(out2), 1e-6);
        float alpha = clamp((1.0 - out2) / soft + 0.5, 0.0, 1.0);
        if (alpha <= 0.0) discard;
        vec3 ray = normalize(at);
        float along = dot(ray, middle), depth2 = size * size - (dot(middle, middle) - along * along);
        vec3 hit = ray * (along - sqrt(max(depth2, 0.0))), normal = (hit - middle) / size;
        vec4 clip = projectionMatrix * vec4(hit, 1.0);
        gl_FragDepth = 0.5 * clip.z / clip.w + 0.5;
        float light = 0.42 + 0.58 * max(dot(normal, normalize(vec3(-0.35, 0.55, 0.9))), 0.0);
        float rim = smoothstep(0.0, 0.35, dot(normal, -ray)); // darker at the edge, so that neighbours are told apart
        colour = vec4(texture(colours, vec2(shade * 0.996 + 0.002, 0.5)).rgb * light * (0.55 + 0.45 * rim), alpha);
      }`,
  });
  const ballMesh = new THREE.Mesh(balls, ballMaterial);
  ballMesh.frustumCulled = false;
  scene.add(ballMesh);

  // Contact forces: strips that face the camera, shaded as rods.
  let chainMesh = null, chains = null;
  if (data.chains && data.chains.count) {
    chains = data.chains;
    const rods = new THREE.InstancedBufferGeometry();
    rods.setAttribute("position", new THREE.BufferAttribute(new Float32Array([0, -1, 0, 1, -1, 0, 1, 1, 0, 0, 1, 0]), 3));
    rods.setIndex([0, 1, 2, 0, 2, 3]);
    rods.instanceCount = chains.count;
    for (const [name, items] of [["start", 3], ["end", 3], ["thick", 1]])
      rods.setAttribute(name, new THREE.InstancedBufferAttribute(floats(chains[name]), items));
    rods.setAttribute("value", new THREE.InstancedBufferAttribute(floats(chains.values), 1));
    chains.first = new Int32Array(bytes(chains.a));
    chains.second = new Int32Array(bytes(chains.b));
    for (const name of ["motionA", "motionB"])
      rods.setAttribute(name, new THREE.InstancedBufferAttribute(new Float32Array(3 * chains.count), 3));
    chainMesh = new THREE.Mesh(rods, new THREE.ShaderMaterial({
      glslVersion: THREE.GLSL3, uniforms: shared, side: THREE.DoubleSide,
      vertexShader: `
        in vec3 start; in vec3 end; in vec3 motionA; in vec3 motionB; in float thick; in float value;
        uniform float swing; uniform vec4 cut;
        out float across; flat out float shade;
        ${cutting}
        void main() {
          shade = value;
          across = position.y;
          vec3 a = (modelViewMatrix * vec4(start + swing * motionA, 1.0)).xyz;
          vec3 b = (modelViewMatrix * vec4(end + swing * motionB, 1.0)).xyz;
          vec3 side = cross(b - a, 0.5 * (a + b));
          side = length(side) > 0.0 ? normalize(side) : vec3(0.0);
          vec3 x = mix(a, b, position.x) + thick * across * side;
          gl_Position = beyond(0.5 * (start + end)) ? vec4(2.0, 2.0, 2.0, 1.0) : projectionMatrix * vec4(x, 1.0);
        }`,
      fragmentShader: `
        precision highp float;
        in float across; flat in float shade;
        uniform sampler2D colours;
        layout(location = 0) out vec4 colour;
        void main() {
          colour = vec4(texture(colours, vec2(shade * 0.996 + 0.002, 0.5)).rgb * (0.45 + 0.55 * sqrt(max(1.0 - across * across, 0.0))), 1.0);
        }`,
    }));
    chainMesh.frustumCulled = false;
    chainMesh.visible = false;
    scene.add(chainMesh);
    $("chains-label").hidden = false;
  }

  // Walls and the frame
  const walls = new THREE.Group();
  for (const wall of data.walls) {
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute("position", new THREE.BufferAttribute(floats(wall.triangles), 3));
    // A plane is seen from where the balls are, so that none stands between them and the camera.
    const material = new THREE.MeshBasicMaterial({color: 0x8796a8, transparent: true, opacity: wall.oneSided ? 0.22 : 0.14,
      depthWrite: false, side: wall.oneSided ? THREE.FrontSide : THREE.DoubleSide});
    walls.add(new THREE.Mesh(geometry, material));
    if (!wall.oneSided)
      walls.add(new THREE.LineSegments(new THREE.EdgesGeometry(geometry, 15), new THREE.LineBasicMaterial({color: 0x6d7b8c, transparent: true, opacity: 0.6})));
  }
  scene.add(walls);
  $("walls-label").hidden = data.walls.length === 0;
  const frame = new THREE.BufferGeometry();
  frame.setAttribute("position", new THREE.BufferAttribute(floats(data.lines), 3));
  scene.add(new THREE.LineSegments(frame, new THREE.LineBasicMaterial({color: 0x8a929c, transparent: true, opacity: 0.7})));

  // The colour bar
  const tick = (x) => (x === 0 ? "0" : Math.abs(x) >= 1e-3 && Math.abs(x) < 1e5 ? String(Number(x.toPrecision(3))) : x.toExponential(2));
  const element = (tag, properties, ...inside) => {
    const made = Object.assign(document.createElement(tag), properties);
    made.append(...inside);
    return made;
  };
  const bar = ({name, unit, low, high, above}) => {
    const strip = element("canvas", {width: 256, height: 1});
    strip.setAttribute("aria-hidden", "true");
    strip.getContext("2d").putImageData(new ImageData(new Uint8ClampedArray(table), 256, 1), 0, 0);
    const ticks = (high > low ? [0, 0.25, 0.5, 0.75, 1] : [0]).map((part) =>
      element("span", {textContent: (part === 1 && above ? "≥ " : "") + tick(low + part * (high - low))}));
    return [element("div", {className: "name", textContent: unit ? `${name} [${unit}]` : name}), strip, element("div", {className: "ticks"}, ...ticks)];
  };
  const showBar = () => {
    const shown = shared.shrink.value > 0 ? bar(data.columns[current]) : [];
    if (chainMesh && chainMesh.visible) shown.push(...bar({...chains, name: "normal force of contacts", unit: "N"}));
    $("bar").replaceChildren(...shown);
  };

  let current = data.first, mode = 0;
  const columnOfModes = data.columns.findIndex((one) => one.values < 0);
  const showColumn = () => {
    const {values} = data.columns[current];
    if (values >= 0) column.array.set(floats(values));
    else
      for (let k = 0; k < count; ++k)
        column.array[k] = Math.hypot(motion.array[3 * k], motion.array[3 * k + 1], motion.array[3 * k + 2]);
    column.needsUpdate = true;
    showBar();
    wanted = true;
  };
  const showMode = () => {
    motion.array.set(displacements[mode]);
    motion.needsUpdate = true;
    if (chainMesh) {
      for (const [name, rows] of [["motionA", chains.first], ["motionB", chains.second]]) {
        const attribute = chainMesh.geometry.getAttribute(name);
        rows.forEach((row, c) => {
          for (let i = 0; i < 3; ++i) attribute.array[3 * c + i] = row < 0 ? 0 : displacements[mode][3 * row + i];
        });
        attribute.needsUpdate = true;
      }
    }
    const {participation} = data.modes[mode];
    $("participation").textContent = `participation ratio ${tick(participation)}`;
    // A mode of few balls would be hidden among the others.
    $("least").value = shared.least.value = participation < 0.1 && current === columnOfModes ? 0.05 : 0;
    showColumn();
  };

  // What one can do
  const option = (select, text, value) => select.add(new Option(text, value));
  data.columns.forEach((one, k) => option($("column"), one.name, k));
  $("column").value = current;
  $("column").addEventListener("input", () => { current = Number($("column").value); showColumn(); });
  $("least").addEventListener("input", () => { shared.least.value = Number($("least").value); wanted = true; });
  $("ball-size").addEventListener("input", () => { shared.shrink.value = Number($("ball-size").value); showBar(); wanted = true; });
  const axes = {"no cut": [0, 0, 0], "across x": [1, 0, 0], "across y, from the front": [0, -1, 0], "across z": [0, 0, 1]};
  Object.keys(axes).forEach((name) => option($("cut-axis"), name, name));
  const ends = new Float32Array([1e9, 1e9, 1e9, -1e9, -1e9, -1e9]);
  for (let k = 0; k < 3 * count; ++k) {
    ends[k % 3] = Math.min(ends[k % 3], position[k]);
    ends[3 + (k % 3)] = Math.max(ends[3 + (k % 3)], position[k]);
  }
  const cutNow = () => {
    const normal = axes[$("cut-axis").value], part = Number($("cut").value);
    const axis = normal.findIndex((x) => x !== 0);
    $("cut").disabled = axis < 0;
    let from = 0, to = 0;
    if (axis >= 0) [from, to] = normal[axis] > 0 ? [ends[axis], ends[3 + axis]] : [-ends[3 + axis], -ends[axis]];
    shared.cut.value.set(...normal, axis < 0 ? 1 : from + part * (to - from) + 1e-6);
    wanted = true;
  };
  $("cut-axis").addEventListener("input", () => {
    if (Number($("cut").value) === 1) $("cut").value = 0.5;
    cutNow();
  });
  $("cut").addEventListener("input", cutNow);
  $("chains").addEventListener("input", () => {
    chainMesh.visible = $("chains").checked;
    if (chainMesh.visible) $("ball-size").value = shared.shrink.value = 0;
    else if (shared.shrink.value === 0) $("ball-size").value = shared.shrink.value = 1;
    showBar();
    wanted = true;
  });
  $("walls").addEventListener("input", () => { walls.visible = $("walls").checked; wanted = true; });

  // The panel stands beside the scene where there is room for both.
  const beside = () => (window.innerWidth > 700 && $("about").open ? $("about").getBoundingClientRect().right : 0);
  const distance = () => 1.05 / Math.sin((0.5 * Math.PI * camera.fov) / 180) / Math.min(1, (window.innerWidth - beside()) / window.innerHeight);
  const look = (x, y, z) => {
    controls.target.set(0, 0, 0);
    // Straight from above there is no way up; next to it there is.
    camera.position.set(x, y, z).addScaledVector(new THREE.Vector3(0, -1, 0), x === 0 && y === 0 ? 1e-4 : 0).setLength(distance());
    controls.update();
    wanted = true;
  };
  const zoom = (factor) => {
    camera.position.sub(controls.target).multiplyScalar(factor).add(controls.target);
    controls.update();
    wanted = true;
  };
  const turn = (about, above) => {
    const offset = camera.position.clone().sub(controls.target).applyAxisAngle(camera.up, about);
    const right = new THREE.Vector3().crossVectors(camera.up, offset).normalize();
    const turned = offset.clone().applyAxisAngle(right, above);
    if (Math.abs(turned.angleTo(camera.up) - Math.PI / 2) < Math.PI / 2 - 0.02) offset.copy(turned);
    camera.position.copy(controls.target).add(offset);
    controls.update();
    wanted = true;
  };
  const move = (right, up) => {
    const step = 0.05 * camera.position.distanceTo(controls.target);
    const by = new THREE.Vector3().setFromMatrixColumn(camera.matrix, 0).multiplyScalar(right * step);
    by.addScaledVector(new THREE.Vector3().setFromMatrixColumn(camera.matrix, 1), up * step);
    camera.position.add(by);
    controls.target.add(by);
    controls.update();
    wanted = true;
  };
  document.querySelectorAll("[data-view]").forEach((button) =>
    button.addEventListener("click", () => look(...button.dataset.view.split(",").map(Number))));
  document.querySelectorAll("[data-zoom]").forEach((button) => button.addEventListener("click", () => zoom(Number(button.dataset.zoom))));
  view.addEventListener("keydown", (event) => {
    const [x, y] = {ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1]}[event.key] || [0, 0];
    if (x || y) event.shiftKey ? move(x, y) : turn(0.1 * x, -0.1 * y);
    else if (event.key === "+" || event.key === "=") zoom(0.9);
    else if (event.key === "-") zoom(1 / 0.9);
    else return;
    event.preventDefault();
  });

  // Which ball is it?
  let pressed = null;
  view.addEventListener("pointerdown", (event) => (pressed = [event.clientX, event.clientY]));
  view.addEventListener("click", (event) => {
    if (!pressed || Math.hypot(event.clientX - pressed[0], event.clientY - pressed[1]) > 4) return;
    const box = view.getBoundingClientRect();
    const caster = new THREE.Raycaster();
    caster.setFromCamera(new THREE.Vector2((2 * (event.clientX - box.left)) / box.width - 1, 1 - (2 * (event.clientY - box.top)) / box.height), camera);
    const {origin, direction} = caster.ray, cut = shared.cut.value, swing = shared.swing.value;
    let nearest = Infinity, found = -1;
    for (let k = 0; k < count; ++k) {
      const [x, y, z] = position.subarray(3 * k, 3 * k + 3);
      if (cut.x * x + cut.y * y + cut.z * z > cut.w || column.array[k] < shared.least.value) continue;
      const dx = x + swing * motion.array[3 * k] - origin.x, dy = y + swing * motion.array[3 * k + 1] - origin.y, dz = z + swing * motion.array[3 * k + 2] - origin.z;
      const along = dx * direction.x + dy * direction.y + dz * direction.z, r = radius[k] * shared.shrink.value;
      const deep = r * r - (dx * dx + dy * dy + dz * dz - along * along);
      if (deep > 0 && along - Math.sqrt(deep) < nearest && along > 0) [nearest, found] = [along - Math.sqrt(deep), k];
    }
    $("picked").hidden = found < 0;
    if (found < 0) return;
    const lines = [`ball ${identity[found]} (row ${found})`];
    const {low, high, name, unit} = data.columns[current];
    lines.push(`${name}: ${tick(low + column.array[found] * (high - low))}${unit && ` ${unit}`}`);
    if (name !== "radius") lines.push(`radius: ${tick(radius[found] * data.size)} m`);
    $("picked").replaceChildren(...lines.map((text) => element("div", {textContent: text})));
  });

  // Modes
  let playing = displacements.length > 0 && !window.matchMedia("(prefers-reduced-motion: reduce)").matches, phase = 0.25, before = 0;
  if (displacements.length) {
    for (const id of ["mode-label", "amplitude-label", "participation", "play-row"]) $(id).hidden = false;
    data.modes.forEach((one, k) => option($("mode"), one.name, k));
    $("mode").addEventListener("input", () => { mode = Number($("mode").value); showMode(); });
    $("amplitude").addEventListener("input", () => (wanted = true));
    const label = () => ($("play").textContent = playing ? "Pause" : "Play");
    $("play").addEventListener("click", () => { playing = !playing; label(); wanted = true; });
    label();
    showMode();
  }
  let mean = 0;
  for (let k = 0; k < count; ++k) mean += radius[k] / count;
  // At full amplitude the largest displacement is five mean radii, or a fifth of all.
  const longest = Math.min(5 * mean, 0.4);

  $("about").open = window.innerWidth > 700;
  $("facts").textContent = data.facts;
  $("extent").textContent = data.extent;
  ground();
  const resize = () => {
    renderer.setSize(window.innerWidth, window.innerHeight, false);
    camera.aspect = window.innerWidth / window.innerHeight;
    camera.setViewOffset(window.innerWidth, window.innerHeight, -0.5 * beside(), 0, window.innerWidth, window.innerHeight);
    wanted = true;
  };
  $("about").addEventListener("toggle", resize);
  window.addEventListener("resize", resize);
  resize();
  look(...[[1, 0, 0], [0, -1, 0], [0, 0, 1], [1, -1.6, 0.9]][data.flat < 0 ? 3 : data.flat]);
  cutNow();
  showColumn();
  const draw = (now) => {
    requestAnimationFrame(draw);
    if (playing) phase += Math.min((now - before) / 1000, 0.1) * 0.6;
    before = now;
    if (!playing && !wanted) return;
    wanted = false;
    shared.swing.value = displacements.length ? Number($("amplitude").value) * longest * Math.sin(2 * Math.PI * phase) : 0;
    renderer.render(scene, camera);
    document.documentElement.dataset.drawn = "yes";
  };
  requestAnimationFrame(draw);
})().catch((error) => {
  const problem = document.getElementById("problem");
  problem.hidden = false;
  problem.textContent = problem.textContent || `This page cannot be shown: ${error.message}`;
  console.error(error);
});
