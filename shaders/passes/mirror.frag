// What surfaces of facets mirror of the world, and others show of it straight on, where nothing stands in the way.
uniform sampler2D mirrored_radiance;
uniform sampler2D surface_normal;  // of what does; w: 0 where nothing does

out vec4 radiance;

void main() {
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  radiance = texelFetch(surface_normal, pixel, 0).w == 0.0 ? texelFetch(mirrored_radiance, pixel, 0) : vec4(0.0);
}
