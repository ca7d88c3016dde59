/* A program that links one room with only those below it: that it links is the test. */
int main(void) {
    return 0;
}
