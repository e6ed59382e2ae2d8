"""Others' ways to do what tmpud does, each as small as its library allows."""
