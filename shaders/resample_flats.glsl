// What is the same for all pixels of a draw of the lattice's image, from the vertex shader to the fragment shader, as lavapipe loads uniforms
// for each pixel by itself. Parameter: FLAT, `out` or `in`.
layout(location = 0) flat FLAT float pitch;      // GatherFrame::pitch
layout(location = 1) flat FLAT int firstSeen;    // first and last of the samples that are seen, along the axis of the step
layout(location = 2) flat FLAT int lastSeen;
layout(location = 3) flat FLAT int firstRow;     // ResamplePush::firstRow
layout(location = 4) flat FLAT int rowSamples;   // samples of a row of the lattice
