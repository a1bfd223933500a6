// one
#version 450
