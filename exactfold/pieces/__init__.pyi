from exactfold.pieces.joining import find_pieces as find_pieces
from exactfold.pieces.result import Joint as Joint
from exactfold.pieces.result import Pieces as Pieces
