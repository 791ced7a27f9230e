// One for each triangle that covers a texel's middle.

out vec4 count;

void main() { count = vec4(1.0); }
