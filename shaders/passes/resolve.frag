// The mean of the samples, turned so that the first row read back is the top of the picture.

uniform sampler2D sum;
uniform float samples;

out vec4 colour;

void main() {
  ivec2 size = textureSize(sum, 0);
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  colour = texelFetch(sum, ivec2(pixel.x, size.y - 1 - pixel.y), 0) / samples;
}
